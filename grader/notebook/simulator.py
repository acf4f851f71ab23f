"""`with simulator() as sim:` in a cell: run a turtlesim and show its canvas below the cell.

    with simulator() as sim:
        %ros2 topic list
        sim.run("draw_circle", seconds=7)

turtlesim runs in a separate process, which is stopped when the `with` statement ends, the cell is interrupted, or the
kernel exits.
"""

from __future__ import annotations

import io
import os
import signal
import struct
import subprocess
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.errors import MachineError, UsageError
from grader.notebook.cells import run_below
from grader.notebook.mode import grading

if TYPE_CHECKING:
    from types import TracebackType

    from typing_extensions import Self

START_S = 120.0
"""The maximum time to wait for turtlesim's first picture (s). A busy machine may need many seconds. If turtlesim exits,
the wait ends at once."""

_MOST_SAID = 10_000
"""The maximum length of turtlesim's output that is read (bytes)."""


class Simulator:
    """A running turtlesim that is shown below the cell. Nothing is run when nbgrader executes the notebook."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._said: IO[bytes] = io.BytesIO()
        self._picture = b""
        self._changed = threading.Event()
        self._reader: threading.Thread | None = None
        self._nodes: list[subprocess.Popen[bytes]] = []
        self._env: dict[str, str] = {}

    def __enter__(self) -> Self:
        if grading():
            return self
        from IPython.display import Image, display

        self._env = environment()
        # A file, since turtlesim would wait when a pipe is full: at a wall, it logs a warning for each frame.
        self._said = tempfile.TemporaryFile()
        live = interpreter("-m", "grader.turtlesim.live", env=self._env, searches=True)
        self._process = subprocess.Popen(
            live.argv,
            cwd="/",
            env=live.env,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            self._changed.wait(START_S)
        except BaseException:  # the cell was interrupted
            self._end()
            raise
        if not self._picture:
            output = self._end()
            message = f"turtlesim did not start: {(output.strip().splitlines() or ['it printed nothing'])[-1]}"
            raise MachineError(message)
        self._handle = display(Image(self._picture), display_id=True)  # type: ignore[no-untyped-call]
        threading.Thread(target=self._show, daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        for node in self._nodes:
            node.send_signal(signal.SIGINT)
        for node in self._nodes:
            _wait_or_kill(node)
        self._nodes.clear()
        if self._process is not None:
            self._end()

    def run(self, executable: str, seconds: float = 7.0) -> None:
        """Run a node of the package next to the notebook for some seconds, and print its output.

        Raises:
            UsageError: the file of the node does not exist.
        """
        if not grading():
            argv, folder = _command(executable)
            run_below(argv, cwd=folder, env=self._env, seconds=seconds)

    def start(self, executable: str) -> None:
        """Start a node without waiting for its exit. The node is stopped at the end of the `with` statement.

        Raises:
            UsageError: the file of the node does not exist.
        """
        if not grading():
            argv, folder = _command(executable)
            self._nodes.append(
                subprocess.Popen(
                    argv,
                    cwd=folder,
                    env=self._env,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    start_new_session=True,
                )
            )

    def wait(self, seconds: float) -> None:
        """Let the turtle move for some seconds."""
        if not grading():
            time.sleep(seconds)

    def picture(self) -> bytes:
        """Return the current canvas as a PNG, or empty bytes when nbgrader executes the notebook."""
        return self._picture

    def _end(self) -> str:
        """Stop the process and show its last picture. Return its standard error."""
        process = self._process
        assert process is not None
        assert process.stdin is not None
        with suppress(OSError):
            process.stdin.close()
        _wait_or_kill(process)
        if self._reader is not None:
            self._reader.join(2.0)
        if self._picture and hasattr(self, "_handle"):
            self._update()
        self._said.seek(max(0, self._said.seek(0, os.SEEK_END) - _MOST_SAID))
        output = self._said.read().decode("utf-8", "replace")
        self._said.close()
        self._process = None
        self._changed.set()
        return output

    def _read(self) -> None:
        assert self._process is not None
        stream = self._process.stdout
        assert stream is not None
        with stream:
            while len(head := stream.read(4)) == 4:
                self._picture = stream.read(*struct.unpack(">I", head))
                self._changed.set()
        self._changed.set()

    def _show(self) -> None:
        while self._process is not None:
            self._changed.wait()
            self._changed.clear()
            if self._process is not None:
                self._update()

    def _update(self) -> None:
        from IPython.display import Image

        self._handle.update(Image(self._picture))  # type: ignore[no-untyped-call]


def _wait_or_kill(process: subprocess.Popen[bytes]) -> None:
    try:
        process.wait(5.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _command(executable: str) -> tuple[list[str], Path]:
    """Return the command that starts a node of the package next to the notebook, and the folder to run it in."""
    name = executable.removesuffix(".py")
    files = [file for file in Path.cwd().glob(f"*/*/{name}.py") if file.parent.name == file.parent.parent.name]
    if not files:
        message = f"The package next to this notebook has no {name}.py. Write the file with `%%node {name}.py`."
        raise UsageError(message)
    package = files[0].parent
    start = f"import sys; sys.path.insert(0, {str(package.parent)!r}); from {package.name}.{name} import main; main()"
    return interpreter("-c", start, searches=True).argv, package.parent


def environment() -> dict[str, str]:
    """Return the kernel's environment, with ROS 2 added if this is not the course's kernel."""
    from grader.ros.installation import find_ros, users_environment
    from grader.ros.underlay import with_turtlesim

    return users_environment(with_turtlesim(find_ros()), os.environ)

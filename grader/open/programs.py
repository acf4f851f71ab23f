"""The programs that a page can start: turtlesim, and a node of the step, which runs in a sandbox cell if possible."""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
from collections import deque
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.learner.run_node import turtle_is_there
from grader.open.linked_cell import linkable
from grader.ros.shell import users_environment
from grader.view.address import Address, remembered

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

KEPT = 200
"""The maximum number of lines of a program's output that are kept."""
LONGEST = 500
"""The maximum length of a line of a program's output (characters)."""
ENDS_S = 8.0
"""The maximum time for a program to exit after Ctrl-C (s). After this time, the program is killed."""
READY_S = 30.0
"""The maximum time for starting turtlesim (s)."""
NO_CELL = "The program cannot run in the sandbox here, so it runs under your account, as in a terminal."
_LOOK_S = 0.05
_NO_DAEMON = {"GRADER_ROS2_DAEMON": "0"}
"""Without this variable, a ros2 daemon would be started, and would continue to run after `grader open` has exited."""
_ADDRESS = re.compile(r"See the turtle move: http://127\.0\.0\.1:(\d+)/#(\S+)")
_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")


def _turtle_is_there() -> bool:
    env = users_environment(None, lambda _: None, {**os.environ, **_NO_DAEMON})
    return turtle_is_there(env)


class Program:
    """A program that may be running, with the last lines of its output. `changed` is called after each change."""

    def __init__(self, changed: Callable[[], object]) -> None:
        self.lines: deque[str] = deque(maxlen=KEPT)
        self.was_stopped = False
        """Whether `stop` was called since the program was last started."""
        self._changed = changed
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None
        self._starting = asyncio.Lock()

    @property
    def running(self) -> bool:
        """Whether the program is running."""
        return self._process is not None

    async def start(self, *arguments: str, says: str = "", held: bool = False) -> None:
        """Start `python ARGUMENTS` unless the program is already running.

        `says` is a line that precedes the program's output.

        With `held`, the program's standard input is a pipe that closes when this process ends for any reason.
        """
        async with self._starting:  # a double click asks twice
            if not self.running:
                await self._start(arguments, says, held=held)

    async def _start(self, arguments: Sequence[str], says: str, *, held: bool) -> None:
        # The page shows the turtle, so no other page is opened.
        env = {name: value for name, value in os.environ.items() if name not in _SCREENS}
        # Do not start the ros2 daemon, which would continue to run.
        own = {"PYTHONUNBUFFERED": "1", "GRADER_ROS2_DAEMON": "0"}
        start = interpreter(*arguments, env={**env, **own}, searches=True)
        self.lines.clear()
        self.was_stopped = False
        if says:
            self.lines.extend([says, ""])
        self._process = await asyncio.create_subprocess_exec(
            *start.argv,
            env=start.env,
            stdin=asyncio.subprocess.PIPE if held else asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
            start_new_session=True,
        )
        self._reading = asyncio.create_task(self._read(self._process))
        self._changed()

    async def stop(self) -> None:
        """Stop the program as Ctrl-C does in a terminal, and wait until it has exited."""
        process, reading = self._process, self._reading
        if process is None or reading is None:
            return
        self.was_stopped = True
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT)
        try:
            await asyncio.wait_for(asyncio.shield(reading), ENDS_S)
        except asyncio.TimeoutError:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            await reading

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdout is not None
        while chunk := await process.stdout.read(65536):
            # Join a line that arrives in two pieces, and truncate a very long line.
            first, *rest = chunk.decode("utf-8", "replace").split("\n")
            if self.lines:
                self.lines[-1] = (self.lines[-1] + first)[:LONGEST]
            else:
                self.lines.append(first[:LONGEST])
            self.lines.extend(line[:LONGEST] for line in rest)
            self._changed()
        await process.wait()
        self._process = None
        self._changed()


class Programs:
    """turtlesim and the node of a step."""

    def __init__(self, changed: Callable[[], object], workspace: Path | None) -> None:
        self.turtlesim = Program(changed)
        self.node = Program(changed)
        self._workspace = workspace
        self._changed = changed
        self._doing = ""
        self._address: Address | None = None
        self._ran = ("", "")
        """The step of the node, and the digest of its code when the node was started."""

    def address(self) -> Address | None:
        """Return the address of the view of turtlesim, or None.

        This is the view of the turtlesim that the page started. If there is none, it is the view of the turtlesim that
        was last started in a terminal. In both cases, turtlesim may no longer be running.
        """
        return self._address or remembered("turtlesim")

    def _printed_address(self) -> Address | None:
        """Return the first address that turtlesim has printed. Its later output can contain any text."""
        found = next(filter(None, map(_ADDRESS.fullmatch, self.turtlesim.lines)), None)
        return Address(int(found[1]), found[2]) if found else None

    async def beside_another(self) -> bool:
        """Return True if another turtlesim is running and `self.turtlesim` is not.

        A second turtlesim would receive the same commands.
        """
        return not self.turtlesim.running and await asyncio.to_thread(_turtle_is_there)

    @contextmanager
    def doing(self, text: str) -> Iterator[None]:
        """Show the text on the page while the `with` block is running, because starting a program takes seconds."""
        self._tell(text)
        try:
            yield
        finally:
            self._tell("")

    def _tell(self, text: str) -> None:
        self._doing = text
        self._changed()

    async def start_turtlesim(self) -> None:
        """Start `grader sim --view`. Wait at most READY_S until turtlesim is ready or has exited."""
        if not self.turtlesim.running:
            self._address = None
        await self.turtlesim.start("-m", "grader.cli", "sim", "--view")
        # Wait for turtlesim, because a node that starts earlier would start a second turtlesim.
        for _ in range(round(READY_S / _LOOK_S)):
            self._address = self._address or self._printed_address()
            if not self.turtlesim.running or any("Spawning turtle" in line for line in self.turtlesim.lines):
                return
            await asyncio.sleep(_LOOK_S)

    async def start_node(self, step: str, executable: str, digest: str) -> None:
        """Start turtlesim if necessary, and this executable of the step: in a cell if possible, else with `grader run`.

        `digest` is the digest of the code.
        """
        if not self.node.running:
            self.node.lines.clear()
        if not await self.beside_another():
            self._tell("Starting turtlesim")
            await self.start_turtlesim()
        self._tell(f"Starting {executable}")
        self._ran = (step, digest)
        workspace = str(self._workspace) if self._workspace else None
        if await asyncio.to_thread(linkable):
            settings = {"step": step, "executable": executable, "workspace": workspace}
            await self.node.start("-m", "grader.open.node_in_cell", json.dumps(settings), held=True)
            return
        given = ["--workspace", workspace] if workspace else []
        await self.node.start("-m", "grader.cli", "run", *given, "--no-view", step, executable, says=NO_CELL)

    async def stop(self) -> None:
        """Stop both programs."""
        await asyncio.gather(self.node.stop(), self.turtlesim.stop())

    def data(self, step: str, digest: str) -> Mapping[str, object]:
        """Return the data for a page, ready for JSON. `digest` is the current digest of the step's code."""
        ran_step, ran_digest = self._ran
        failed = not self.turtlesim.running and not self.turtlesim.was_stopped
        # The address of the view contains its token.
        lines = [line for line in self.turtlesim.lines if not _ADDRESS.search(line)]
        return {
            "turtlesim": self.turtlesim.running,
            "problem": "\n".join(lines).strip()[-LONGEST:] if failed else "",
            "node": self.node.running,
            "old": self.node.running and ran_step == step and "" not in (digest, ran_digest) and ran_digest != digest,
            "busy": self._doing != "",
            "doing": self._doing or ("Starting your node" if self.node.running and not self.node.lines else ""),
            "lines": list(self.node.lines),
        }

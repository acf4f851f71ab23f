"""Load the extension: add the magics, `check` and `simulator`, and start a guardian for child processes."""

from __future__ import annotations

import os
import secrets
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.errors import GraderError
from grader.notebook import guardian
from grader.notebook.cells import Cells
from grader.notebook.check import Checking
from grader.notebook.mode import confined
from grader.notebook.simulator import Simulator

if TYPE_CHECKING:
    from types import TracebackType

    from IPython.core.interactiveshell import InteractiveShell


def load(shell: InteractiveShell) -> None:
    """Add the magics and functions to this shell."""
    # A sandbox needs no guardian, because its processes are killed together with it.
    if not confined():
        _guard()
    cells = Cells()
    for name in ("step", "lesson", "ros2"):
        shell.register_magic_function(getattr(cells, name), "line", name)
    for name in ("node", "package", "answers"):
        shell.register_magic_function(getattr(cells, name), "cell", name)
    shell.push({"check": Checking(cells).check, "simulator": Simulator}, interactive=False)  # type: ignore[no-untyped-call]
    shell.set_custom_exc((GraderError,), _tell)  # type: ignore[no-untyped-call]


def _tell(
    shell: InteractiveShell,
    kind: type[BaseException],  # noqa: ARG001
    error: BaseException,
    traceback: TracebackType,  # noqa: ARG001
    tb_offset: int | None = None,  # noqa: ARG001
) -> list[str]:
    """Show an error of the grader as a message without a traceback."""
    shell._showtraceback(GraderError, error, [str(error)])  # type: ignore[no-untyped-call, unused-ignore]
    return [str(error)]


def _guard() -> None:
    """Mark the kernel's future child processes, and start the guardian that stops them after the kernel has exited."""
    mark = f"{os.getpid()}-{secrets.token_hex(8)}"
    # Only this process has the write end of the pipe, because Python does not pass descriptors to child processes.
    # The guardian must not inherit the kernel's folder or mark.
    env = {"PATH": os.environ.get("PATH", ""), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}
    start = interpreter(str(Path(guardian.__file__).absolute()), mark, env=env)
    started = subprocess.Popen(
        start.argv,
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        cwd="/",
        env=start.env,
    )
    _guardians.append(started)
    os.environ[guardian.VARIABLE] = mark


_guardians: list[subprocess.Popen[bytes]] = []
"""Keeps the guardian's Popen object until the kernel exits. If the object were deleted, its pipe would be closed."""

"""Wait for an event that a test has caused. If the event does not happen before a deadline, the test fails."""

from __future__ import annotations

import os
import select
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

HANG_S = 600.0
"""Longer than anything that a test waits for, also on a machine that is 20 times slower because of other work (s)."""
LONG_S = 1500.0
"""The time limit for several commands in a row (s). It is less than the time limit of a test in pyproject.toml."""
_POLL_S = 0.05


def until(there: Callable[[], bool]) -> None:
    """Wait until the condition is true."""
    deadline = time.monotonic() + HANG_S
    while not there():
        assert time.monotonic() < deadline
        time.sleep(_POLL_S)


def is_crowded(said: str) -> bool:
    """Return whether a report says that the machine was too busy to judge, and this machine is indeed busy."""
    return "The machine was too busy" in said and os.getloadavg()[0] > 2.0 * (os.cpu_count() or 1)


def only_child(pid: int) -> int:
    """Wait until a process has exactly one child process, and return the id of the child process.

    The child process may not have been started yet, and others may still be ending.
    """
    file = Path(f"/proc/{pid}/task/{pid}/children")
    found: list[str] = []

    def one() -> bool:
        found[:] = file.read_text("ascii").split()
        return len(found) == 1

    until(one)
    return int(found[0])


def until_gone(pid: int) -> None:
    """Wait until a process has ended. If the process is a child of this process, it may be waited for afterwards."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    try:
        assert select.select([descriptor], [], [], HANG_S)[0], f"process {pid} is still there: {_described(pid)}"
    finally:
        os.close(descriptor)


def _described(pid: int) -> str:
    """Return the command line of a process, its state and signals, and the system call in which it waits."""
    described = []
    for name in ("cmdline", "wchan", "status"):
        with suppress(OSError):
            described.append((Path("/proc") / str(pid) / name).read_text("utf-8", "replace").replace("\0", " "))
    return "\n".join(described)

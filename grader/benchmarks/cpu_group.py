"""Count the CPU time of a command and of all its descendants in a control group.

The kernel adds the CPU time of a process to the CPU time of its parent when the parent waits for the process. No
process waits for the processes that are still running when a sandbox cell ends. Therefore, without a control group,
most of the CPU time of a build or trial may not be counted.

This module needs version 1 of control groups. In version 2, a process can be in only one group, and each sandbox cell
already has its own group.
"""

from __future__ import annotations

import itertools
import os
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.sandbox.control_group import TREE, ControlGroup

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

_ENDED_S = 5.0
_numbers = itertools.count()


@dataclass(frozen=True)
class CpuGroup:
    """A control group that counts CPU time. `folder` is None if groups cannot be created."""

    folder: Path | None

    def joined(self, argv: Sequence[str]) -> list[str]:
        """Return the command that joins the group and then runs `argv`."""
        return ControlGroup((self.folder,)).joined(argv) if self.folder else list(argv)

    def wait(self) -> None:
        """Wait a short time for all processes of the group to exit."""
        until = time.monotonic() + _ENDED_S
        while self.folder and (self.folder / "cgroup.procs").read_text().strip() and time.monotonic() < until:
            time.sleep(0.01)

    def cpu_s(self) -> float | None:
        """Return the CPU time that the group has used (s), or None if there is no group."""
        if self.folder is None:
            return None
        return int((self.folder / "cpuacct.usage").read_text()) / 1e9


@contextmanager
def cpu_group() -> Iterator[CpuGroup]:
    """Yield a new group, which is removed afterwards if all its processes have exited."""
    folder = TREE / "cpuacct" / f"grader-benchmark-{os.getpid()}-{next(_numbers)}"
    try:
        folder.mkdir()
    except OSError:
        yield CpuGroup(None)
        return
    try:
        yield CpuGroup(folder)
    finally:
        with suppress(OSError):
            folder.rmdir()

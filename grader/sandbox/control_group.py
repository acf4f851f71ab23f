"""Control groups: the kernel's own count of what many processes hold together, where one may make them.

Root may nearly everywhere, an ordinary user where systemd has delegated a part of the tree and the grader runs in it.
The wall is `ABOVE` beyond what usage.py allows, so that usage.py ends a cell first and knows why; what grows faster
than it looks, and what the kernel holds for sockets and pipes, stops here.

Both versions are known: in version 2 a group is a folder in one tree, in version 1 one in each controller's
(https://docs.kernel.org/admin-guide/cgroup-v2.html and cgroup-v1/).
"""

from __future__ import annotations

import os
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.sandbox.bubblewrap import Limits

TREE = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
CONTROLLERS = ("memory", "pids")
ABOVE = 512 * 1024 * 1024
"""Memory of a group beyond the cell's total (bytes): the conductor of a trial lives in it too."""
PROCESSES_ABOVE = 200
"""Processes and threads of a group beyond the cell's: those of bubblewrap and of the conductor."""
GONE_S = 2.0
_PREFIX = "grader-"
_JOIN = 'until [ "$1" = -- ]; do echo $$ 2>/dev/null >"$1/cgroup.procs"; shift; done; shift; exec "$@"'
_numbers = count()


@dataclass(frozen=True)
class ControlGroup:
    """A group: one folder (version 2) or one a controller (version 1); none where it cannot be had."""

    folders: tuple[Path, ...] = ()

    def __bool__(self) -> bool:
        """Whether the kernel counts."""
        return bool(self.folders)

    def joined(self, argv: Sequence[str]) -> list[str]:
        """`argv` as the group's: it joins before anything of it runs."""
        if not self.folders:
            return list(argv)
        return ["sh", "-c", _JOIN, "sh", *map(str, self.folders), "--", *argv]

    def out_of_memory(self) -> bool:
        """Whether the kernel has ended a process of the group for the memory that all held."""
        for folder in self.folders:
            for name in ("memory.events", "memory.oom_control"):
                with suppress(OSError):
                    counts = dict(line.split() for line in (folder / name).read_text("ascii").splitlines())
                    return int(counts.get("oom_kill", 0)) > 0
        return False


@contextmanager
def control_group(limits: Limits) -> Iterator[ControlGroup]:
    """A new group for a cell of these limits and what belongs to it; an empty one where none can be had."""
    group = _make(limits)
    try:
        yield group
    finally:
        for folder in group.folders:
            _remove(folder)


def _make(limits: Limits) -> ControlGroup:
    name = f"{_PREFIX}{os.getpid()}-{next(_numbers)}"
    wanted = {
        "memory.max": limits.total_memory + ABOVE,
        "memory.swap.max": 0,
        "memory.limit_in_bytes": limits.total_memory + ABOVE,
        "pids.max": limits.processes + PROCESSES_ABOVE,
    }
    made: list[Path] = []
    try:
        for parent in _parents():
            _remove_left_over(parent)
            folder = parent / name
            folder.mkdir()
            made.append(folder)
            for file, value in wanted.items():
                if (folder / file).exists():
                    (folder / file).write_text(str(value), "ascii")
    except OSError:
        for folder in made:
            _remove(folder)
        return ControlGroup()
    return ControlGroup(tuple(made))


def _parents() -> list[Path]:
    """Where a group can be made: one folder for both controllers, or one each; empty where it cannot."""
    own = dict(_own())
    if all(name in own for name in CONTROLLERS):
        # In a container the path may be the host's: then the top of the tree is its own.
        places = [(TREE / name / own[name].lstrip("/"), TREE / name) for name in CONTROLLERS]
        return [next((place for place in both if os.access(place, os.W_OK)), both[0]) for both in places]
    here = TREE / own.get("", "/").lstrip("/")
    for place in (here, *here.parents):
        if not place.is_relative_to(TREE):
            break
        with suppress(OSError):
            passed_on = (place / "cgroup.subtree_control").read_text("ascii").split()
            # To move a process, its new group and what both groups have in common must be ours.
            if set(CONTROLLERS) <= set(passed_on) and os.access(place / "cgroup.procs", os.W_OK):
                return [place]
    return []


def _own() -> Iterator[tuple[str, str]]:
    """Controller -> the group that this process is in; "" stands for version 2."""
    with suppress(OSError):
        for line in OWN.read_text("utf-8").splitlines():
            _, controllers, path = line.split(":", 2)
            for controller in controllers.split(","):
                yield controller, path


def _remove(folder: Path) -> None:
    """Remove a group; the kernel refuses while a process of it is about to end."""
    until = time.monotonic() + GONE_S
    while folder.is_dir() and time.monotonic() < until:
        with suppress(OSError):
            folder.rmdir()
            return
        time.sleep(0.005)


def _remove_left_over(parent: Path) -> None:
    """Remove the groups of graders that were killed."""
    for folder in parent.glob(f"{_PREFIX}*"):
        pid = folder.name.removeprefix(_PREFIX).partition("-")[0]
        if pid.isdecimal() and not Path("/proc", pid).exists():
            with suppress(OSError):
                folder.rmdir()

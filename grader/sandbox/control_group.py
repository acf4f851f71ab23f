"""Control groups: the kernel limits the total resource use of a cell, if the grader is allowed to create groups.

Root can create control groups nearly everywhere. An ordinary user can create control groups if systemd has delegated a
part of the tree and the grader runs in that part. The memory limit of the group is the limit that usage.py checks plus
`ABOVE`, so that usage.py stops a cell first and records the reason. The group stops processes that grow too fast for
usage.py, and limits socket and pipe memory.

Versions 1 and 2 of control groups are supported. In version 2, a group is a folder in one tree. In version 1, a group
is a folder in each controller's tree (https://docs.kernel.org/admin-guide/cgroup-v2.html and cgroup-v1/).
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

    from grader.sandbox.limits import Limits

TREE = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
CONTROLLERS = ("memory", "pids")
ABOVE = 512 * 1024 * 1024
"""The memory (bytes) that a group may use in addition to the cell's total, for the conductor of a trial
(trial/conductor.py)."""
PROCESSES_ABOVE = 200
"""In addition to the cell's limit, a control group allows this many processes and threads, for bubblewrap and the
conductor."""
GONE_S = 2.0
_PREFIX = "grader-"
_JOIN = 'until [ "$1" = -- ]; do echo $$ 2>/dev/null >"$1/cgroup.procs"; shift; done; shift; exec "$@"'
_numbers = count()


@dataclass(frozen=True)
class ControlGroup:
    """A control group: one folder (version 2), one per controller (version 1), or none if groups cannot be created."""

    folders: tuple[Path, ...] = ()

    def __bool__(self) -> bool:
        """Whether the group exists: False if groups cannot be created."""
        return bool(self.folders)

    def joined(self, argv: Sequence[str]) -> list[str]:
        """Return the command that joins the group and then runs `argv`."""
        if not self.folders:
            return list(argv)
        return ["sh", "-c", _JOIN, "sh", *map(str, self.folders), "--", *argv]

    def out_of_memory(self) -> bool:
        """Return whether the kernel killed a process because the group used too much memory."""
        for folder in self.folders:
            for name in ("memory.events", "memory.oom_control"):
                with suppress(OSError):
                    counts = dict(line.split() for line in (folder / name).read_text("ascii").splitlines())
                    return int(counts.get("oom_kill", 0)) > 0
        return False


@contextmanager
def control_group(limits: Limits) -> Iterator[ControlGroup]:
    """Yield a new group for a cell with these limits.

    If groups cannot be created, the group has no folder and limits nothing.

        with control_group(limits) as group:
            subprocess.run(group.joined(command), check=True)
    """
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
    """Return the folders in which a group can be created: one for both controllers, one per controller, or none."""
    own = dict(_own())
    if all(name in own for name in CONTROLLERS):
        # In a container, this may be a path of the host. In this case, the group is the root of the container's tree.
        places = [(TREE / name / own[name].lstrip("/"), TREE / name) for name in CONTROLLERS]
        return [next((place for place in both if os.access(place, os.W_OK)), both[0]) for both in places]
    own_group = TREE / own.get("", "/").lstrip("/")
    for place in (own_group, *own_group.parents):
        if not place.is_relative_to(TREE):
            break
        with suppress(OSError):
            passed_on = (place / "cgroup.subtree_control").read_text("ascii").split()
            # Moving a process requires write access to its new group and to the common parent of both groups.
            if set(CONTROLLERS) <= set(passed_on) and os.access(place / "cgroup.procs", os.W_OK):
                return [place]
    return []


def _own() -> Iterator[tuple[str, str]]:
    """Yield each controller, and the path of this process's group in the controller's tree.

    In version 2, the name of the controller is "".
    """
    with suppress(OSError):
        for line in OWN.read_text("utf-8").splitlines():
            _, controllers, path = line.split(":", 2)
            for controller in controllers.split(","):
                yield controller, path


def _remove(folder: Path) -> None:
    """Remove a group. The kernel does not remove a group before all of its processes have exited."""
    until = time.monotonic() + GONE_S
    while folder.is_dir():
        with suppress(OSError):
            folder.rmdir()
            return
        if time.monotonic() > until:
            return
        time.sleep(0.005)


def _remove_left_over(parent: Path) -> None:
    """Remove the groups of graders that were killed."""
    for folder in parent.glob(f"{_PREFIX}*"):
        pid = folder.name.removeprefix(_PREFIX).partition("-")[0]
        if pid.isdecimal() and not Path("/proc", pid).exists():
            with suppress(OSError):
                folder.rmdir()

"""The resource limits of a cell: memory, processes, files, processor time and disk.

Resource limits (setrlimit(2)) apply to each process. usage.py and control_group.py limit the totals of a cell.
"""

from __future__ import annotations

import os
import resource
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Sequence

MIB = 1024 * 1024
MOST_SIGNALS = 1000
"""The maximum number of pending signals and POSIX timers of a cell. The kernel counts them per user."""
NO_CORE_DUMP = 1
"""The limit on core dumps (bytes). With the limit 0, the kernel would still pass core dumps to another program; see
core(5)."""
LEAST_MEMORY = 2048 * MIB
"""The address space that the machine must allow each program to use (bytes). With less, a node or a test may fail
because of the machine."""
RAISE_MEMORY = "ulimit -v unlimited"
FREE_PROCESSES = 128
"""The number of processes and threads that a grading may need at the same time, beside the user's other processes. In
measurements, a check of step 07 needed 116, and one of step 03 needed 49."""
RAISE_PROCESSES = f"ulimit -u {32 * FREE_PROCESSES}"
MOST_OTHERS = 4096
"""Without cells, this number is added to the limit on processes, because the user's other processes also count."""


@dataclass(frozen=True)
class Limits:
    """The limits of a cell.

    `memory` limits the address space of each process, and `disk` limits each writable tmpfs (bytes).
    """

    memory: int = 4096 * MIB
    total_memory: int = 2048 * MIB
    """The maximum memory of all processes, disks and sockets of a cell together (bytes), which usage.py watches."""
    processes: int = 600
    """The maximum number of processes and threads together. ROS timers do not count, because they run without threads
    of their own."""
    open_files: int = 1024
    file_size: int = 256 * MIB
    disk: int = 256 * MIB
    files: int = 50_000
    """The maximum number of files on all writable disks together, which usage.py watches."""
    cpu_s: int = 120


NODE_LIMITS = Limits()
"""The limits of a node in a trial."""
_OPTIONS = {
    resource.RLIMIT_NPROC: "nproc",
    resource.RLIMIT_AS: "as",
    resource.RLIMIT_NOFILE: "nofile",
    resource.RLIMIT_FSIZE: "fsize",
    resource.RLIMIT_CPU: "cpu",
    resource.RLIMIT_CORE: "core",
    resource.RLIMIT_SIGPENDING: "sigpending",
    resource.RLIMIT_RTPRIO: "rtprio",
    resource.RLIMIT_NICE: "nice",
    resource.RLIMIT_MEMLOCK: "memlock",
}
"""Maps resource limits to the options of prlimit(1)."""


def require_memory() -> None:
    """Check that programs may use enough memory.

    Raises:
        MachineError: a limit on the address space of each program, such as `ulimit -v`, is too low.
    """
    most = min(limit for limit in (*resource.getrlimit(resource.RLIMIT_AS), sys.maxsize) if limit >= 0)
    if most < LEAST_MEMORY:
        message = (
            f"Each program may use at most {most // MIB} MiB of address space here, and a node needs up to "
            f"{LEAST_MEMORY // MIB} MiB: type `{RAISE_MEMORY}`, or use a terminal without this limit."
        )
        raise MachineError(message)


def require_processes() -> None:
    """Check that this user may start enough processes and threads. The kernel does not limit those of root.

    Raises:
        MachineError: a limit on the processes and threads of the user, such as `ulimit -u`, is too low.
    """
    most = resource.getrlimit(resource.RLIMIT_NPROC)[0]
    # Such a high limit is usually not reached, and counting the threads of all processes takes a while.
    if os.geteuid() == 0 or most == resource.RLIM_INFINITY or most >= 32 * FREE_PROCESSES:
        return
    running = _threads_of_user()
    if most - running < FREE_PROCESSES:
        message = (
            f"This user may run at most {most} processes and threads here, and {running} are already running. A "
            f"grading needs up to {FREE_PROCESSES} more: type `{RAISE_PROCESSES}`, or use a terminal without this "
            "limit."
        )
        raise MachineError(message)


def _threads_of_user() -> int:
    """Return the number of threads of all processes of this user that are visible in /proc."""
    threads = 0
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if process.stat().st_uid == os.geteuid():
                threads += sum(1 for _ in (process / "task").iterdir())
    return threads


def limited(argv: Sequence[str], limits: Limits, *, in_cell: bool = False) -> list[str]:
    """Return the command that runs `argv` under resource limits, which also work without bubblewrap."""
    set_limits = resource_limits(limits, in_cell=in_cell)
    options = [f"--{name}={set_limits[kind]}" for kind, name in _OPTIONS.items() if kind in set_limits]
    # If the machine runs out of memory, the kernel kills this process first.
    return ["prlimit", *options, "--", "choom", "-n", "1000", "--", *argv]


def resource_limits(limits: Limits, *, in_cell: bool) -> dict[int, int]:
    """Return the resource limits of a process: the constants of the module `resource`, and the values."""
    # Outside a cell, the kernel counts all processes of the user, and usage.py counts those of the program.
    wanted = {
        resource.RLIMIT_NPROC: limits.processes if in_cell else limits.processes + MOST_OTHERS,
        resource.RLIMIT_AS: limits.memory,
        resource.RLIMIT_NOFILE: limits.open_files,
        resource.RLIMIT_FSIZE: limits.file_size,
        resource.RLIMIT_CPU: limits.cpu_s,
        resource.RLIMIT_CORE: NO_CORE_DUMP,
    }
    if in_cell:
        wanted[resource.RLIMIT_SIGPENDING] = MOST_SIGNALS
        # Users of robots may often use real-time priorities and lock memory. A cell must neither take the processors
        # away from the grader, nor keep the files of the machine in memory, which its limit on memory does not count.
        wanted |= dict.fromkeys((resource.RLIMIT_RTPRIO, resource.RLIMIT_NICE, resource.RLIMIT_MEMLOCK), 0)
    return {kind: allowed(kind, value) for kind, value in wanted.items()}


def allowed(which: int, wanted: int) -> int:
    """Return the wanted limit, or the user's hard limit if it is lower. Only root can raise a hard limit."""
    hard = resource.getrlimit(which)[1]
    return wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)

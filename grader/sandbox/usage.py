"""Watch the total resource use of a cell: its processes, their memory, the data in its sockets, its disks and files.

Resource limits apply to each process separately, and bubblewrap limits the bytes of a tmpfs but not its files. Control
groups limit totals, but not every user can create control groups. Checking the totals ten times per second works
everywhere.
"""

from __future__ import annotations

import os
import re
import sys
import time
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from grader.sandbox.limits import Limits

EVERY_S = 0.1
LAUNCHERS = 16
"""The number of processes that may exist in addition to the student's processes, such as those of bubblewrap.

In a cell, the kernel also limits the number of processes, and its limit is lower.
"""
_DISKS = ("ws", "tmp", "dev/shm")
_SOCKETS = {"udp": "", "udp6": "", "tcp": "sockstat", "tcp6": "sockstat6"}
"""Maps each list of sockets in /proc/PID/net to the file there that counts these sockets, or to "" if no count is
needed. For a list of TCP sockets, the kernel looks through the TCP sockets of all networks, which takes 4 ms.
Therefore, such a list is read only if this network has TCP sockets."""
_IN_USE = re.compile(rb"^TCP6?: inuse (\d+)", re.MULTILINE)
_MOST_LISTED = 4 * 1024 * 1024
"""A list of sockets that is longer than this (bytes) has more than 25,000 lines, which happens only in an attack."""
_MEMORY = re.compile(r"^(?:RssAnon|RssShmem|VmSwap|VmPTE):\s*(\d+) kB", re.MULTILINE)
"""The lines of /proc/PID/status about the memory of a process: its own pages, shared pages, swapped pages and page
tables, but not mapped files."""
_THREADS = re.compile(r"^Threads:\s*(\d+)", re.MULTILINE)
_TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


def exceeded(pids: Sequence[int], limits: Limits, *, in_room: bool = False) -> str | None:
    """Return the limit ("memory", "processes", "files") that these processes and their descendants exceed, or None.

    With `in_room`, this process and the cell are in the same room, so the cell can fill the sockets of their network.
    """
    memory = 0
    processes = 0
    disks: dict[int, tuple[int, int]] = {}
    networks = {_network(os.getpid()): os.getpid() if in_room else 0}
    for process in family(*pids):
        own, threads = _own_bytes_and_threads(process)
        memory += own
        processes += threads
        networks.setdefault(_network(process), process)
        if not disks:
            disks = _disks(process)
    memory += sum(used for used, _ in disks.values())
    memory += sum(map(_waiting_bytes, filter(None, networks.values())))
    if memory > limits.total_memory:
        return "memory"
    if processes > limits.processes + LAUNCHERS:
        return "processes"
    return "files" if sum(files for _, files in disks.values()) > limits.files else None


class Guard:
    """A thread that watches processes and their descendants, usually those of a cell, until `close` is called.

    If they exceed a limit, the thread calls `over` with the name of the limit, and ends.

    `in_room` has the same meaning as in `exceeded`.
    """

    def __init__(
        self, pids: Sequence[int], limits: Limits, over: Callable[[str], None], *, in_room: bool = False
    ) -> None:
        self._pids, self._limits, self._over, self._in_room = pids, limits, over, in_room
        self._first = frozenset(family(*pids))
        self._worked = [(time.monotonic(), sum(map(cpu_s, self._first)))]
        self._ready: dict[int, float] = {}
        self._short_s = 0.0
        self._others = False
        self._waited: dict[int, float] = {}
        self._closed = Event()
        self._thread = Thread(target=self._run, name="guard", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop watching."""
        self._closed.set()
        self._thread.join()

    def worked_s(self, begin: float, end: float) -> float:
        """Return approximately the CPU time (s) that the cell used between two times of CLOCK_MONOTONIC.

        The CPU time is read every EVERY_S, so CPU time shortly before `begin` or after `end` may count, too.
        """
        first = self._worked[0][1]
        before = max((cpu for at, cpu in self._worked if at <= begin), default=first)
        return max((cpu for at, cpu in self._worked if at <= end + EVERY_S), default=first) - before

    def ready_s(self, *, but: int) -> float:
        """Return the time for which all processes of the cell except `but` have run or waited for a processor (s).

        On a crowded machine, a process gets less CPU time, but the total time for which it runs or waits is about the
        same. Only the first thread of each process is counted. Most processes that live for less than EVERY_S are never
        observed, so for the processes that were started under the guard, the result is at least the number of those
        observed in state R, multiplied by the time since the previous observation.
        """
        return max(sum(ready_s for pid, ready_s in self._ready.copy().items() if pid != but), self._short_s)

    def has_others(self) -> bool:
        """Return whether processes that were started under the guard existed at the last observation.

        Exited processes for which nobody has waited do not count.
        """
        return self._others

    def waited_s(self, *, of: int | None = None) -> float:
        """Return the time for which the cell's processes, or only the process `of`, have waited for a processor (s).

        Only the first thread of each process is counted.
        """
        return sum(waited_s for pid, waited_s in self._waited.copy().items() if of in (None, pid))

    def _run(self) -> None:
        while not self._closed.wait(EVERY_S):
            processes = list(family(*self._pids))
            before = self._worked[-1][0]
            self._worked.append((time.monotonic(), sum(map(cpu_s, processes))))
            states = [_state(process) for process in processes if process not in self._first]
            self._short_s += states.count("R") * (self._worked[-1][0] - before)
            self._others = any(state not in ("", "Z", "X") for state in states)
            for process in processes:
                ran_s, waited_s = _ran_and_waited_s(process)
                self._ready[process] = max(ran_s + waited_s, self._ready.get(process, 0.0))
                self._waited[process] = max(waited_s, self._waited.get(process, 0.0))
            what = exceeded(self._pids, self._limits, in_room=self._in_room)
            if what is not None:
                self._over(what)
                return


def family(*pids: int) -> Iterator[int]:
    """Yield the processes and all their descendants.

    In a cell, orphans are included, because they become children of the cell's first process.
    """
    waiting = [*pids]
    while waiting:
        process = waiting.pop()
        yield process
        try:
            for task in os.listdir(f"/proc/{process}/task"):  # noqa: PTH208 - many, often
                waiting += map(int, _read(f"/proc/{process}/task/{task}/children").split())
        except OSError:
            continue


def _own_bytes_and_threads(pid: int) -> tuple[int, int]:
    """Return the memory of the process (bytes) without mapped files, and the number of its threads.

    Shared memory counts for each process that uses it.
    """
    try:
        status = _read(f"/proc/{pid}/status")
    except OSError:
        return 0, 0
    threads = _THREADS.search(status)
    return 1024 * sum(map(int, _MEMORY.findall(status))), int(threads[1]) if threads is not None else 0


def _network(pid: int) -> str:
    """Return the network namespace of the process, or "" if it is unknown."""
    try:
        return os.readlink(f"/proc/{pid}/ns/net")  # noqa: PTH115 - many, often
    except OSError:
        return ""


def _waiting_bytes(pid: int) -> int:
    """Return how many bytes of data are waiting in the UDP and TCP sockets of the process's network.

    The kernel has one limit on this memory for all networks of the machine. If this limit is reached, messages of other
    trials are lost.
    """
    total = 0
    for name, counts in _SOCKETS.items():
        try:
            if counts and not any(map(int, _IN_USE.findall(_read_bytes(f"/proc/{pid}/net/{counts}")))):
                continue
            listed = _read_bytes(f"/proc/{pid}/net/{name}")
        except OSError:
            continue
        if len(listed) == _MOST_LISTED:
            return sys.maxsize
        for line in listed.splitlines()[1:]:
            sends, _, receives = line.split(maxsplit=5)[4].partition(b":")
            total += int(sends, 16) + int(receives, 16)
    return total


def cpu_s(pid: int) -> float:
    """Return the CPU time of the process and of its exited children (s)."""
    try:
        fields = _read(f"/proc/{pid}/stat").rpartition(")")[2].split()
    except OSError:
        return 0.0
    # utime, stime, cutime and cstime of proc(5). The first value of this list is the state (field 3).
    return sum(map(int, fields[11:15])) * _TICK_S


def _state(pid: int) -> str:
    """Return the state of the first thread of the process (see proc(5)), or "" if the process does not exist."""
    try:
        return _read(f"/proc/{pid}/stat").rpartition(")")[2].split(maxsplit=1)[0]
    except OSError:
        return ""


def _ran_and_waited_s(pid: int) -> tuple[float, float]:
    """Return how long the first thread of the process has run, and how long it has waited for a processor (s)."""
    try:
        ran_ns, waited_ns, _ = _read(f"/proc/{pid}/schedstat").split()
    except (OSError, ValueError):
        return 0.0, 0.0
    return int(ran_ns) / 1e9, int(waited_ns) / 1e9


def _disks(pid: int) -> dict[int, tuple[int, int]]:
    """Return the number of bytes and the number of files on each writable disk of the cell, by device.

    The result is empty for a process outside the cell, or if the process has exited.
    """
    root = Path(f"/proc/{pid}/root")
    found = {}
    try:
        here, there = Path("/").stat(), root.stat()
        if (here.st_dev, here.st_ino) == (there.st_dev, there.st_ino) or not (root / _DISKS[0]).is_dir():
            return {}
        for name in _DISKS:
            disk = os.statvfs(root / name)
            used = (disk.f_blocks - disk.f_bfree) * disk.f_frsize
            found[(root / name).stat().st_dev] = used, disk.f_files - disk.f_ffree
    except OSError:
        return {}
    return found


def _read_bytes(path: str) -> bytes:
    with open(path, "rb") as file:  # noqa: PTH123 - quicker
        return file.read(_MOST_LISTED)


def _read(path: str) -> str:
    with open(path, encoding="utf-8", errors="replace") as file:  # noqa: PTH123 - quicker
        return file.read()

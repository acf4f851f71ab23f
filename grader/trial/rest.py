"""Rest: detect whether a process is idle, without affecting the process.

Simulated time advances only while the node is idle: every thread sleeps, and no thread ran while the states of the
threads were read from /proc. A thread that was woken but has not run yet is in state R. If a thread has run, the CPU
time of its process has grown. The kernel measures this time in ns and updates it when the thread falls asleep. Reading
it is a single system call for all threads (clock_getcpuclockid(3)), much faster than reading files in /proc.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.process_stat import EXITED, has_exited, stat_fields
from grader.trial.wait import HIDDEN, Wait, wait_of

if TYPE_CHECKING:
    from collections.abc import Callable

DDS = "dds."
"""The prefix of the names of Fast DDS's threads."""
_DDS_TIMERS = "dds.ev"
"""The prefix of the name of the thread that runs the timers of Fast DDS. This thread sends data but does not receive
any."""
_SLEEPING = ord("S")
# The kind of a CPU clock, in the low bits of its number (include/linux/posix-timers.h).
_OF_PROCESS, _OF_THREAD = 2, 6


class GoneError(Exception):
    """The process has exited."""


class DoubtError(Exception):
    """Simulated time may misjudge the process, for example because the process follows wall time or is always busy.

    The message gives the reason.

    `by_chance` is true if another run of the same program might not raise this error.
    """

    def __init__(self, why: str, *, by_chance: bool = False) -> None:
        super().__init__(why)
        self.by_chance = by_chance


@dataclass(frozen=True)
class Look:
    """One observation of some threads: whether all of them are sleeping, and the line of each thread in schedstat.

    The line has the CPU time (ns), the time for which the thread waited for a processor (ns), and how many times it has
    run.
    """

    asleep: bool
    runs: tuple[bytes, ...]

    @property
    def counted(self) -> bool:
        """Whether this kernel counts how many times each thread has run."""
        return any(run != b"0 0 0\n" for run in self.runs)


def of_dds(thread: str) -> bool:
    """Return whether a thread of this name belongs to Fast DDS."""
    return thread.startswith(DDS)


def not_of_dds(thread: str) -> bool:
    """Return whether a thread with this name does not belong to Fast DDS."""
    return not of_dds(thread)


def receives(thread: str) -> bool:
    """Return whether a thread of this name can receive messages."""
    return of_dds(thread) and not thread.startswith(_DDS_TIMERS)


class Threads:
    """The threads of a process. If `wanted` is given, only the threads whose names `wanted` accepts are observed.

    The files of the threads in /proc are kept open.
    """

    def __init__(self, pid: int, wanted: Callable[[str], bool] = lambda _: True) -> None:
        self.pid = pid
        self._wanted = wanted
        self._names: dict[int, str] = {}
        self._files: dict[int, tuple[int, int]] = {}
        self._clocks: tuple[int, ...] = ()
        self._main = self._open(pid, "stat")
        self._count = b""
        try:
            self._refresh()
        except (GoneError, OSError):
            self.close()
            raise

    def close(self) -> None:
        """Close the threads' files in /proc."""
        for pair in self._files.values():
            for fd in pair:
                os.close(fd)
        os.close(self._main)
        self._files = {}

    def look(self) -> Look:
        """Read the state of every thread once.

        Raises:
            GoneError: the process has exited.
        """
        for _ in range(100):
            main = self._refresh()
            try:
                asleep, runs = True, []
                for tid, (stat, schedstat) in self._files.items():
                    # Read the state first. If a thread is in state S but just falling asleep, its count changes a
                    # moment later.
                    asleep &= (main if tid == self.pid else _state(os.pread(stat, 64, 0))) == _SLEEPING
                    runs.append(os.pread(schedstat, 64, 0))
            except ProcessLookupError:  # a thread has exited in the meantime
                self._count = b""
                continue
            return Look(asleep, tuple(runs))
        raise GoneError

    def cpu_ns(self) -> tuple[int, ...]:
        """Return the CPU time used so far (ns), which has grown if a thread has run and fallen asleep since.

        For the threads of this process, the result has the CPU time of each observed thread, and otherwise the total
        of all threads of the process, also of those that have exited. If the process or an observed thread of this
        process has exited, or if the system does not measure CPU times, the result differs from all other results.
        """
        try:
            return tuple([time.clock_gettime_ns(clock) for clock in self._clocks])
        except OSError:
            return (-time.monotonic_ns(),)

    def asleep(self) -> bool:
        """Return whether every thread is sleeping. If a thread has just exited, return False.

        Raises:
            GoneError: the process has exited.
        """
        main = self._refresh()
        try:
            for tid, (stat, _) in self._files.items():
                if (main if tid == self.pid else _state(os.pread(stat, 64, 0))) != _SLEEPING:
                    return False
        except ProcessLookupError:
            self._count = b""
            return False
        return True

    def only(self, cpu_ns: tuple[int, ...], wanted: Callable[[str], bool]) -> tuple[int, ...]:
        """Return the values of `cpu_ns`, the last result for this process, whose threads' names `wanted` accepts."""
        return tuple([ns for tid, ns in zip(self._files, cpu_ns, strict=True) if wanted(self._names[tid])])

    def main_asleep(self) -> bool:
        """Return whether the main thread is sleeping, without checking the other threads.

        Raises:
            GoneError: the process no longer exists.
        """
        try:
            return _state(os.pread(self._main, 64, 0)) not in b"RD"
        except ProcessLookupError:
            raise GoneError from None

    def times_s(self) -> dict[int, tuple[float, float]]:
        """Return the times (s) for which each thread has run and waited for a processor, by thread id.

        Raises:
            GoneError: the process has exited.
        """
        self._refresh()
        found = {}
        for tid, (_, schedstat) in self._files.items():
            with suppress(ProcessLookupError):  # the thread has exited
                ran, waited, _ = os.pread(schedstat, 64, 0).split()
                found[tid] = int(ran) / 1e9, int(waited) / 1e9
        return found

    def run_time_s(self) -> float:
        """Return the CPU time (s) that the process has used, including threads that have exited.

        If the system does not measure the CPU time of processes, only the observed threads count.

        Raises:
            GoneError: the process has exited.
        """
        self._refresh()
        try:
            return time.clock_gettime_ns(~self.pid << 3 | _OF_PROCESS) / 1e9
        except OSError:
            return sum(ran_s for ran_s, _ in self.times_s().values())

    def run_times_s(self) -> dict[int, float]:
        """Return the CPU time (s) that each thread has used, by thread id, without the threads of Fast DDS."""
        found = self.times_s()
        return {tid: ran_s for tid, (ran_s, _) in found.items() if tid == self.pid or not_of_dds(self._names[tid])}

    def waits(self) -> list[Wait]:
        """Return the reason why each thread is waiting, except for the threads of Fast DDS.

        The reason for a thread that is running is "running".
        """
        self._refresh()
        found = []
        for tid in self._files:
            if tid != self.pid and of_dds(self._names[tid]):
                continue
            try:
                words = _read(f"/proc/{self.pid}/task/{tid}/syscall").split()
            except PermissionError:
                found.append(Wait(tid, self._names[tid], HIDDEN, timed=False))
                continue
            except OSError:
                continue
            found.append(wait_of(tid, self._names[tid], words))
        return found

    def _refresh(self) -> int:
        """Find the threads of the process, unless their number is unchanged. Return the state of the main thread."""
        try:
            fields = stat_fields(os.pread(self._main, 512, 0))
        except ProcessLookupError:
            raise GoneError from None
        if has_exited(fields):
            raise GoneError
        # A main thread that has exited before the other threads never runs again.
        state = _SLEEPING if fields[0] in EXITED else fields[0][0]
        if fields[17] == self._count and self._files:
            return state
        try:
            tids = {int(task.name) for task in Path(f"/proc/{self.pid}/task").iterdir()}
        except FileNotFoundError:
            raise GoneError from None
        for tid in set(self._names) - tids:
            del self._names[tid]
            for fd in self._files.pop(tid, ()):
                os.close(fd)
        for tid in sorted(tids - set(self._names)):
            self._add(tid)
        self._count = fields[17]
        own = self.pid == os.getpid()
        self._clocks = tuple(~tid << 3 | _OF_THREAD for tid in self._files) if own else (~self.pid << 3 | _OF_PROCESS,)
        return state

    def _add(self, tid: int) -> None:
        try:
            name = _read(f"/proc/{self.pid}/task/{tid}/comm").strip()
            self._names[tid] = name
            if self._wanted(name):
                stat = self._open(tid, "stat")
                try:
                    self._files[tid] = (stat, self._open(tid, "schedstat"))
                except (GoneError, OSError):
                    os.close(stat)
                    raise
        except (FileNotFoundError, ProcessLookupError, GoneError):
            self._names.pop(tid, None)

    def _open(self, tid: int, name: str) -> int:
        try:
            return os.open(f"/proc/{self.pid}/task/{tid}/{name}", os.O_RDONLY | os.O_CLOEXEC)
        except (FileNotFoundError, ProcessLookupError):
            raise GoneError from None


def _read(path: str) -> str:
    # This function is called many times in a trial, so it does not use pathlib, which takes ten times as long.
    fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        return os.read(fd, 512).decode("utf-8", "replace")
    finally:
        os.close(fd)


def _state(stat: bytes) -> int:
    # A thread can have any name of up to 15 bytes, even ") R". The kernel's fields follow the last parenthesis.
    return stat[stat.rindex(b")") + 2]

"""Rest: whether a process has nothing left to do for now. /proc tells, without disturbing the process.

Simulated time advances only when the node rests: every thread sleeps, and none ran between two looks. A thread that
ran between two looks has another count in its schedstat. A thread that was woken and did not run yet is in state R. So
two equal looks are enough if the kernel counts, and the first look needs no states. Otherwise, more looks are needed.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

DDS = "dds."
"""The prefix of the names of the threads of Fast DDS."""
_DDS_TIMERS = "dds.ev"
"""The thread for its timers: it sends, and receives nothing."""
_SLEEPING = ord("S")
# The system calls that wait for a time to pass, by their numbers on x86-64.
_SLEEPS = {35: "nanosleep", 230: "clock_nanosleep"}
# The word that holds the time-out (word 0 is the number of the system call), and its value without a time-out.
_FOREVER = {0xFFFFFFFF, 0xFFFFFFFFFFFFFFFF}
_MAY_END = {
    202: ("futex", 4, {0}),
    7: ("poll", 3, _FOREVER),
    271: ("ppoll", 3, {0}),
    23: ("select", 5, {0}),
    270: ("pselect6", 5, {0}),
    232: ("epoll_wait", 4, _FOREVER),
    281: ("epoll_pwait", 4, _FOREVER),
}


class GoneError(Exception):
    """The process has ended."""


class DoubtError(Exception):
    """The process may follow wall time, so its rest means nothing. The message says why."""


@dataclass(frozen=True)
class Look:
    """One look at some threads: whether all of them sleep, and how often each ran."""

    asleep: bool
    runs: tuple[bytes, ...]

    @property
    def counted(self) -> bool:
        """Whether this kernel counts how often a thread ran."""
        return any(run != b"0 0 0\n" for run in self.runs)


@dataclass(frozen=True)
class Wait:
    """What a thread waits for: the name of a system call (or "futex", "running", ...), and whether it is timed."""

    tid: int
    thread: str
    call: str
    timed: bool


def of_dds(thread: str) -> bool:
    """Return whether a thread of this name belongs to Fast DDS."""
    return thread.startswith(DDS)


def not_of_dds(thread: str) -> bool:
    """Return whether a thread of this name belongs to the program itself."""
    return not of_dds(thread)


def receives(thread: str) -> bool:
    """Return whether a thread of this name may receive messages."""
    return of_dds(thread) and not thread.startswith(_DDS_TIMERS)


def only_sends(thread: str) -> bool:
    """Return whether a thread of this name belongs to Fast DDS and receives nothing."""
    return of_dds(thread) and not receives(thread)


class Threads:
    """The threads of a process, or only those with `wanted` names. Their files in /proc stay open."""

    def __init__(self, pid: int, wanted: Callable[[str], bool] = lambda _: True) -> None:
        self.pid = pid
        self._wanted = wanted
        self._names: dict[int, str] = {}
        self._files: dict[int, tuple[int, int]] = {}
        self._main = self._open(pid, "stat")
        self._count = b""
        self._refresh()

    def close(self) -> None:
        """Close these files."""
        for pair in self._files.values():
            for fd in pair:
                os.close(fd)
        os.close(self._main)
        self._files = {}

    def look(self) -> Look:
        """Look at every thread once.

        Raises:
            GoneError: the process has ended.
        """
        for _ in range(100):
            self._refresh()
            try:
                asleep, runs = True, []
                for stat, schedstat in self._files.values():
                    # The state first: a thread in state S that is just falling asleep has another count a moment later.
                    asleep &= _state(os.pread(stat, 64, 0)) == _SLEEPING
                    runs.append(os.pread(schedstat, 64, 0))
            except ProcessLookupError:  # a thread has ended meanwhile
                self._count = b""
                continue
            return Look(asleep, tuple(runs))
        raise GoneError

    def runs(self) -> tuple[bytes, ...]:
        """Return how often each thread of the last look ran. This costs a third of a look."""
        try:
            return tuple([os.pread(schedstat, 64, 0) for _, schedstat in self._files.values()])
        except ProcessLookupError:  # a thread has ended, or all have: this equals no look
            return ()

    def main_asleep(self) -> bool:
        """Look at the main thread alone.

        Raises:
            GoneError: the process has ended.
        """
        try:
            return _state(os.pread(self._main, 64, 0)) not in b"RD"
        except ProcessLookupError:
            raise GoneError from None

    def run_time_s(self) -> float:
        """Return the CPU time of all threads so far (s)."""
        return sum(int(run.split()[0]) for run in self.look().runs) / 1e9

    def waits(self) -> list[Wait]:
        """Return what each thread waits for now, without those of Fast DDS. A running thread waits for nothing."""
        self._refresh()
        found = []
        for tid in self._files:
            if tid != self.pid and of_dds(self._names[tid]):
                continue
            try:
                words = _read(f"/proc/{self.pid}/task/{tid}/syscall").split()
            except OSError:
                continue
            found.append(_wait(tid, self._names[tid], words))
        return found

    def _refresh(self) -> None:
        try:
            fields = _fields(os.pread(self._main, 512, 0))
        except ProcessLookupError:
            raise GoneError from None
        if fields[0] in (b"Z", b"X"):
            raise GoneError
        if fields[17] == self._count and self._files:
            return
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

    def _add(self, tid: int) -> None:
        try:
            name = _read(f"/proc/{self.pid}/task/{tid}/comm").strip()
            self._names[tid] = name
            if self._wanted(name):
                stat = self._open(tid, "stat")
                self._files[tid] = (stat, self._open(tid, "schedstat"))
        except (FileNotFoundError, ProcessLookupError, GoneError):
            self._names.pop(tid, None)

    def _open(self, tid: int, name: str) -> int:
        try:
            return os.open(f"/proc/{self.pid}/task/{tid}/{name}", os.O_RDONLY | os.O_CLOEXEC)
        except (FileNotFoundError, ProcessLookupError):
            raise GoneError from None


def _read(path: str) -> str:
    # Not with pathlib: it takes ten times as long, and this is called many times in a trial.
    fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        return os.read(fd, 512).decode("utf-8", "replace")
    finally:
        os.close(fd)


def _state(stat: bytes) -> int:
    # A thread can have any name of 15 bytes, even ") R". The fields of the kernel follow the last parenthesis.
    return stat[stat.rindex(b")") + 2]


def _fields(stat: bytes) -> list[bytes]:
    # From the state, [0], on; [17] is the number of threads.
    return stat[stat.rindex(b")") + 2 :].split()


def _wait(tid: int, thread: str, words: list[str]) -> Wait:
    if not words or not words[0].lstrip("-").isdigit():
        return Wait(tid, thread, "running", timed=False)
    number = int(words[0])
    if number in _SLEEPS:
        return Wait(tid, thread, _SLEEPS[number], timed=True)
    if number in _MAY_END:
        name, argument, never = _MAY_END[number]
        return Wait(tid, thread, name, timed=int(words[argument], 16) not in never)
    return Wait(tid, thread, f"system call {number}", timed=False)

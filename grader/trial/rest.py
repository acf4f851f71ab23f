"""Rest: whether a process has done all it can do for now, told from /proc without disturbing it.

Simulated time moves on only when the node rests: every thread sleeps, and none has run between two looks. A thread
that was woken, ran and slept again between the looks has another count in its schedstat; one that was woken and
has not run yet is in state R. So two equal looks are enough where the kernel counts, and the first of them needs no
states; where it does not, more are needed.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

DDS = "dds."
"""How Fast DDS begins the names of its threads."""
_DDS_TIMERS = "dds.ev"
"""The thread of its timers: it sends what is due, and receives nothing."""
_SLEEPING = ord("S")
# x86-64 numbers of the system calls in which a thread waits for a time to pass.
_SLEEPS = {35: "nanosleep", 230: "clock_nanosleep"}
# Which argument is the time-out (the system call's number itself is word 0), and what it is when there is none.
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
    """The process may follow wall time, so that its rest says nothing; the text says why."""


@dataclass(frozen=True)
class Look:
    """One look at some threads: whether all sleep, and how often each has run."""

    asleep: bool
    runs: tuple[bytes, ...]

    @property
    def counted(self) -> bool:
        """Whether this kernel counts how often a thread ran."""
        return any(run != b"0 0 0\n" for run in self.runs)


@dataclass(frozen=True)
class Wait:
    """What a thread waits for: the name of a system call (or "futex", "running", ...), and whether time ends it."""

    tid: int
    thread: str
    call: str
    timed: bool


def of_dds(thread: str) -> bool:
    """Whether a thread of this name is one of Fast DDS's."""
    return thread.startswith(DDS)


def not_of_dds(thread: str) -> bool:
    """Whether a thread of this name is the program's own."""
    return not of_dds(thread)


def receives(thread: str) -> bool:
    """Whether what arrives may come through a thread of this name."""
    return of_dds(thread) and not thread.startswith(_DDS_TIMERS)


def only_sends(thread: str) -> bool:
    """Whether a thread of this name is one of Fast DDS's through which nothing arrives."""
    return of_dds(thread) and not receives(thread)


class Threads:
    """The threads of a process, or those whose names are `wanted`, read through kept descriptors."""

    def __init__(self, pid: int, wanted: Callable[[str], bool] = lambda _: True) -> None:
        self.pid = pid
        self._wanted = wanted
        self._names: dict[int, str] = {}
        self._files: dict[int, tuple[int, int]] = {}
        self._main = self._open(pid, "stat")
        self._count = b""
        self._refresh()

    def close(self) -> None:
        """Close the kept descriptors."""
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
                    # In this order: who says S and is only just falling asleep has another count a moment later.
                    asleep &= _state(os.pread(stat, 64, 0)) == _SLEEPING
                    runs.append(os.pread(schedstat, 64, 0))
            except ProcessLookupError:  # a thread ended meanwhile
                self._count = b""
                continue
            return Look(asleep, tuple(runs))
        raise GoneError

    def runs(self) -> tuple[bytes, ...]:
        """How often each thread of the last look has run: what a look can be compared with, at a third of its price."""
        try:
            return tuple([os.pread(schedstat, 64, 0) for _, schedstat in self._files.values()])
        except ProcessLookupError:  # a thread has ended, or all of them: no look says the same
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
        """Tell what every thread but Fast DDS's waits for right now; a running one waits for nothing."""
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
    # Not pathlib's way: it costs ten times as much, and what a node waits for is read many times in a trial.
    fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        return os.read(fd, 512).decode("utf-8", "replace")
    finally:
        os.close(fd)


def _state(stat: bytes) -> int:
    # A thread may call itself anything, ") R" too, in 15 bytes: what follows the last parenthesis is the kernel's.
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

"""Rest: detect whether a process is idle, by reading /proc, which does not affect the process.

Simulated time advances only while the node is idle: every thread sleeps, and no thread has run between two
observations. If a thread ran between two observations, a counter in its file /proc/.../schedstat has changed. A thread
that was woken but has not run yet is in state R. If the kernel keeps these counters, two equal observations are enough.
The first observation need not include the states of the threads. If the kernel does not keep these counters, more
observations are needed.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

HIDDEN = "hidden"
"""The value of `call` for a thread whose process forbids inspection (PR_SET_DUMPABLE of prctl(2))."""
DDS = "dds."
"""The prefix of the names of Fast DDS's threads."""
_DDS_TIMERS = "dds.ev"
"""The prefix of the name of the thread that runs the timers of Fast DDS. This thread sends data but does not receive
any."""
_SLEEPING = ord("S")
# The system calls that only wait for time to pass, by their numbers on x86-64.
_SLEEPS = {35: "nanosleep", 230: "clock_nanosleep"}
# For each system call that may have a timeout: its name, the word with the timeout (word 0 is the number of the call),
# and the values of that word that mean "no timeout".
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


@dataclass(frozen=True)
class Wait:
    """A thread and the system call in which it is waiting.

    `call` is the name of the system call, such as "futex", or "system call NUMBER" for most system calls. If the thread
    is not waiting, `call` is "running". It can also be HIDDEN. `timed` is true if the wait has a timeout.
    """

    tid: int
    thread: str
    call: str
    timed: bool


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

    def only(self, look: Look, wanted: Callable[[str], bool]) -> tuple[bytes, ...]:
        """Return the schedstat lines in `look`, the last observation, of the threads whose names `wanted` accepts."""
        return tuple([run for tid, run in zip(self._files, look.runs, strict=True) if wanted(self._names[tid])])

    def runs(self) -> tuple[bytes, ...]:
        """Return the schedstat lines of the last observation's threads (see `Look`), or () if one of them has exited.

        Reading the counters is three times as fast as a full observation of the threads.
        """
        try:
            return tuple([os.pread(schedstat, 64, 0) for _, schedstat in self._files.values()])
        except ProcessLookupError:  # a thread has exited, so the result must differ from every observation
            return ()

    def main_asleep(self) -> bool:
        """Return whether the main thread is sleeping, without checking the other threads.

        Raises:
            GoneError: the process no longer exists.
        """
        try:
            return _state(os.pread(self._main, 64, 0)) not in b"RD"
        except ProcessLookupError:
            raise GoneError from None

    def run_time_s(self) -> float:
        """Return the CPU time (s) that all threads have used. Threads that have exited do not count."""
        return sum(int(run.split()[0]) for run in self.look().runs) / 1e9

    def run_times_s(self) -> dict[int, float]:
        """Return the CPU time (s) that each thread has used, by thread id, without the threads of Fast DDS."""
        self._refresh()
        found = {}
        for tid, (_, schedstat) in self._files.items():
            if tid == self.pid or not_of_dds(self._names[tid]):
                with suppress(ProcessLookupError):
                    found[tid] = int(os.pread(schedstat, 64, 0).split()[0]) / 1e9
        return found

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
            found.append(_wait(tid, self._names[tid], words))
        return found

    def _refresh(self) -> int:
        """Find the threads of the process, unless their number is unchanged. Return the state of the main thread."""
        try:
            fields = _fields(os.pread(self._main, 512, 0))
        except ProcessLookupError:
            raise GoneError from None
        state = fields[0][0]
        if state in b"ZX":
            raise GoneError
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


def _fields(stat: bytes) -> list[bytes]:
    # The fields from the state, [0], to the number of threads, [17].
    return stat[stat.rindex(b")") + 2 :].split(b" ", 18)


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

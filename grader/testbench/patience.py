"""The time that one run of the tests may take, regardless of how busy the machine is.

The limits apply to wall time. They do not include the time for which the threads of the run, or the thread that
responds to their requests, waited for a processor. The CPU time of all processes of the run together has the same
limit, so that a run gains no time by keeping the processors busy itself. A run that can never continue is recognized
earlier, since each of its threads is waiting, without a time limit, for another thread of the same process.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path
from signal import SIGALRM
from typing import TYPE_CHECKING

from grader.sandbox.usage import family
from grader.trial.rest import GoneError, Threads, not_of_dds, of_dds

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.rest import Look

    WorkedS = Callable[[float, float], float]
    """The CPU time (s) that all processes of the run used between two times of CLOCK_MONOTONIC."""

LOOK_S = 0.5
"""The interval (s) at which a run is examined while it sends no requests."""
_CALLER = "/proc/thread-self/schedstat"


class Patience:
    """Watches one run. `test_s` is the maximum time for each test (s), and `run_s` for the whole run (s).

    The thread that creates this object must also respond to the requests of the run. `worked_s` returns the CPU time of
    the run's processes.
    """

    def __init__(self, pid: int, test_s: float, run_s: float, worked_s: WorkedS) -> None:
        self._pid = pid
        self._test_s, self._run_s, self._worked_s = test_s, run_s, worked_s
        self._begun = self._test_begun = self._moved = time.monotonic()
        self._waits_ns: dict[int, int] = {}
        self._waited_before_s = 0.0
        self._caller = os.open(_CALLER, os.O_RDONLY | os.O_CLOEXEC)
        self._callers_last_ns, self._callers_waits_ns = self._callers_waited_ns(), 0
        self._seen: Look | None = None
        self.stuck = False
        """Whether the run can never continue."""

    def close(self) -> None:
        """Close the file that this object keeps open."""
        os.close(self._caller)

    def test_ended(self) -> None:
        """Record that a test has ended, and that the next one begins."""
        self._test_begun = time.monotonic()
        self._waited_before_s = self._waited_s()

    def answered(self) -> None:
        """Record that responses have been sent. Call this method whenever requests have been handled."""
        self._moved, self._seen = time.monotonic(), None
        now_ns = self._callers_waited_ns()
        self._callers_waits_ns += now_ns - self._callers_last_ns
        self._callers_last_ns = now_ns

    def is_over(self) -> bool:
        """Return whether the run has exceeded its time, or can never continue."""
        now = time.monotonic()
        self._callers_last_ns = self._callers_waited_ns()
        if now - self._moved >= LOOK_S:
            self._moved = now
            self.stuck = self._is_stuck()
        # Subtracting the time spent waiting for a processor makes these times shorter, so /proc is read only if one of
        # them is too long.
        is_late = now - self._begun >= self._run_s or now - self._test_begun >= self._test_s
        if self.stuck or not is_late:
            return self.stuck
        if self._worked_s(self._begun, now) >= self._run_s:
            return True
        self._look_at_waits()
        waited_s = self._waited_s()
        in_test_s = now - self._test_begun - (waited_s - self._waited_before_s)
        return in_test_s >= self._test_s or now - self._begun - waited_s >= self._run_s

    def _is_stuck(self) -> bool:
        """Return whether all threads of the run are waiting for each other, and have not run since the last call."""
        with suppress(GoneError, OSError, ValueError):
            threads = Threads(self._pid, not_of_dds)
            try:
                before, self._seen = self._seen, threads.look()
                waits = threads.waits()
            finally:
                threads.close()
            seen = self._seen
            rests = seen.asleep and seen.counted and before is not None and seen.runs == before.runs
            if not rests or len(waits) != len(seen.runs) or any(each.call != "futex" for each in waits):
                return False
            timed = [each for each in waits if each.timed]
            is_alone = len(list(family(self._pid))) == 1 and not _has_alarm(self._pid)
            return is_alone and len(timed) <= _has_log(self._pid) and all(each.tid != self._pid for each in timed)
        return False

    def _look_at_waits(self) -> None:
        with suppress(OSError, IndexError):
            for task in Path(f"/proc/{self._pid}/task").iterdir():
                self._waits_ns[int(task.name)] = int((task / "schedstat").read_bytes().split()[1])

    def _waited_s(self) -> float:
        """Return the time (s) for which the run and the responding thread waited for a processor, as last read."""
        return (sum(self._waits_ns.values()) + self._callers_waits_ns) / 1e9

    def _callers_waited_ns(self) -> int:
        return int(os.pread(self._caller, 64, 0).split()[1])


def _has_log(pid: int) -> bool:
    """Return whether rclpy is initialized.

    If so, one of the threads of rclpy runs regularly to write the log, but this thread wakes no other thread.
    """
    threads = Threads(pid, of_dds)
    try:
        return bool(threads.look().runs)
    finally:
        threads.close()


def _has_alarm(pid: int) -> bool:
    """Return whether the process handles SIGALRM, which can wake it from any wait."""
    status = Path(f"/proc/{pid}/status").read_text("ascii", "replace")
    caught = next((line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:")), "0")
    return bool(int(caught, 16) >> (SIGALRM - 1) & 1)

"""The time limit of a whole trial. Only a trial that would never end on its own should reach this limit."""

from __future__ import annotations

import os
import time
from threading import Lock, Timer
from typing import TYPE_CHECKING

from grader.sandbox.usage import cpu_s, family
from grader.trial.crowd import Others

if TYPE_CHECKING:
    from grader.trial.conductor_process import ConductorProcess

MOST_BY_OTHERS = 0.75
"""If other programs used at least this share of the processors, the machine may be the reason why a trial did not end
in time. A node that keeps the simulator busy gets at least half of the processors, even while other trials of a class
are running."""


class TimeLimit:
    """Kills the processes of a trial when they take too long.

    `reached` is then true, and `starved` is true if the machine was too busy.
    """

    def __init__(self, conductor: ConductorProcess) -> None:
        self._conductor = conductor
        self._timer = Timer(0.0, lambda: None)
        self._others = Others()
        self._worked_before_s = self._begun_s = 0.0
        self._changing = Lock()
        self._closed = False
        self.reached = False
        self.starved = False

    def start(self, seconds: float) -> None:
        """Kill the processes after this time (s). A limit that was started earlier no longer applies.

        Another thread may close the limit at any time. After that, `start` does nothing.
        """
        self.cancel()
        others, worked_s, now = Others(), self._worked_s(), time.monotonic()
        with self._changing:
            if not self._closed:
                self._others, self._worked_before_s, self._begun_s = others, worked_s, now
                self._timer = Timer(seconds, self._end)
                self._timer.daemon = True
                self._timer.start()

    def cancel(self) -> None:
        """Cancel the limit, so that the processes are not killed."""
        with self._changing:
            self._timer.cancel()

    def close(self) -> None:
        """Cancel the limit permanently, because the trial is about to end."""
        with self._changing:
            self._closed = True
            self._timer.cancel()

    def _end(self) -> None:
        with self._changing:
            if self._closed:
                return
            worked_s = self._worked_s() - self._worked_before_s
            passed_s = time.monotonic() - self._begun_s
            others_s = self._others.worked_s(but_s=worked_s)
            self.reached = True
            self.starved = others_s >= MOST_BY_OTHERS * len(os.sched_getaffinity(0)) * passed_s
            self._conductor.kill()

    def _worked_s(self) -> float:
        return sum(map(cpu_s, family(*self._conductor.pids())))

"""Detect whether the system's clock was set while a trial was running, or whether the machine was suspended.

The timers of a node in wall time follow this clock. If it is set back by an hour, each timer pauses for an hour.
"""

from __future__ import annotations

import time

SET_S = 0.1
"""If the system's clock and CLOCK_MONOTONIC drift apart by more than this (s), the system's clock was set. To correct
its rate, NTP changes the clock by at most 0.5 ms per second."""
_READINGS = 3


class SystemClock:
    """The system's clock, compared with CLOCK_MONOTONIC since the creation of this object."""

    def __init__(self) -> None:
        self._ahead_s = _ahead_s()
        self._was_set = False

    def was_set(self) -> bool:
        """Return whether this call or an earlier call has found that the clock was set."""
        self._was_set = self._was_set or abs(_ahead_s() - self._ahead_s) > SET_S
        return self._was_set


def _ahead_s() -> float:
    """Return by how much the system's clock is ahead of CLOCK_MONOTONIC (s).

    This process may be interrupted after it has read one clock and before it reads the other. Therefore, the clocks
    are compared several times, and the comparison that took the least time counts.
    """
    readings = []
    for _ in range(_READINGS):
        before = time.monotonic()
        now = time.time()
        readings.append((time.monotonic() - before, now - before))
    return min(readings)[1]

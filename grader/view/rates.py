"""Compute rates from counts of arrivals. The current time (s) is an argument."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

WINDOW_S = 5.0
"""A rate is computed over this time (s), unless the last two arrivals are further apart."""
_LONGEST_S = 30.0
_GAPS = 2.5
"""The messages are considered to have stopped if none arrives for this number of average intervals, and for at least
1 s."""
_AT_LEAST_S = 1.0


@dataclass
class Arrivals:
    """The arrivals of messages on one topic."""

    _observed: deque[tuple[float, int]] = field(default_factory=deque)
    """For each group of messages: the arrival time of its last message, and the number of its messages."""

    def add(self, when_s: float, count: int = 1) -> None:
        """Record that `count` messages have arrived since the last call. The last arrival was at `when_s` (s)."""
        self._observed.append((when_s, count))
        # Only the arrivals of the last WINDOW_S count, but at least two groups.
        while len(self._observed) > 2 and self._observed[0][0] < when_s - WINDOW_S:
            self._observed.popleft()

    def hertz(self, now_s: float) -> float | None:
        """Return the mean rate (Hz).

        Return None if the messages have stopped or are too rare, or if fewer than two groups of messages have arrived.
        """
        if len(self._observed) < 2:
            return None
        (first_s, _), (last_s, _) = self._observed[0], self._observed[-1]
        count = sum(count for _, count in self._observed) - self._observed[0][1]
        if last_s <= first_s:
            return None
        gap_s = (last_s - first_s) / count
        silent_s = now_s - last_s
        if silent_s > max(_GAPS * gap_s, _AT_LEAST_S) or gap_s > _LONGEST_S:
            return None
        return 1 / gap_s

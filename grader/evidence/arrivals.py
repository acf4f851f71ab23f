"""Arrivals of repeated messages, and the intervals between them.

Intervals that were changed by a stall of the machine are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.evidence import activity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.trial.recording import Recording


@dataclass(frozen=True)
class Measured:
    """The arrival times, the intervals between them, and the times before the first and after the last arrival (s).

    `intervals` and `mean_s` leave out the intervals that were changed by a stall of the machine, and the intervals that
    begin in the initial period (`activity.START_S`), unless all intervals begin there. `begins` contains the start
    times of the intervals. `trusted` is the share of intervals that were not changed by a stall.
    """

    arrivals: tuple[float, ...]
    intervals: tuple[float, ...]
    begins: tuple[float, ...]
    trusted: float
    mean_s: float
    first_s: float
    rest_s: float


def measure_arrivals(recording: Recording, times_s: Iterable[float]) -> Measured:
    """Measure the arrivals at these times (s), which must be before the end of the scenario.

    The mean is 0 if there are no intervals.
    """
    arrivals = tuple(times_s)
    until = activity.end_s(recording)
    if not arrivals:
        return Measured((), (), (), 1.0, 0.0, until, until)
    every = list(pairwise(arrivals))
    # Messages that are sent before the clock starts arrive when discovery is over, not when they are sent.
    pairs = [pair for pair in every if pair[0] > activity.START_S] or every
    trusted = [pair for pair in pairs if not any(recording.stalled(t_s) for t_s in pair)]
    intervals = tuple(later - earlier for earlier, later in trusted)
    mean = sum(intervals) / len(intervals) if intervals else 0.0
    share = len(trusted) / len(pairs) if pairs else 1.0
    begins = tuple(earlier for earlier, _ in trusted)
    return Measured(arrivals, intervals, begins, share, mean, arrivals[0], until - arrivals[-1])

"""Arrivals of what comes again and again: the intervals between them, without those that the machine spoilt."""

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
    """Arrivals (s): intervals between them, their mean, the wait before the first and after the last.

    `intervals` and `mean_s` leave out those that a stall of the machine made longer or shorter, and those that begin at
    the very start (`seen.START_S`); `trusted` is the share that no stall spoilt.
    """

    arrivals: tuple[float, ...]
    intervals: tuple[float, ...]
    begins: tuple[float, ...]
    trusted: float
    mean_s: float
    first_s: float
    rest_s: float


def measure_arrivals(recording: Recording, times_s: Iterable[float]) -> Measured:
    """Measure arrivals before SIGINT; the mean is 0 when there are fewer than two."""
    arrivals = tuple(times_s)
    until = activity.end_s(recording)
    if not arrivals:
        return Measured((), (), (), 1.0, 0.0, until, until)
    every = list(pairwise(arrivals))
    # What was sent before the clock started came when the two sides had found each other, and not when it was sent.
    pairs = [pair for pair in every if pair[0] > activity.START_S] or every
    trusted = [pair for pair in pairs if not any(recording.stalled(t_s) for t_s in pair)]
    intervals = tuple(later - earlier for earlier, later in trusted)
    mean = sum(intervals) / len(intervals) if intervals else 0.0
    share = len(trusted) / len(pairs) if pairs else 1.0
    begins = tuple(earlier for earlier, _ in trusted)
    return Measured(arrivals, intervals, begins, share, mean, arrivals[0], until - arrivals[-1])

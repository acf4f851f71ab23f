"""Tolerances: whether a measured value is inside, or so near an edge that another clock might decide otherwise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.outcome import Finding, Status

if TYPE_CHECKING:
    from grader.trial.recording import Recording

NEAR = 0.2
"""A value is near an edge when this share of the tolerance or less lies between (docs/design.md, decision 3)."""


@dataclass(frozen=True)
class Band:
    """The values from `low` to `high`; `low_width` and `high_width` are the tolerances that these edges came from.

    None: no edge on that side. NaN is never inside: comparisons with it are false, so they say what must hold.
    """

    low: float | None
    high: float | None
    low_width: float = 0.0
    high_width: float = 0.0

    @classmethod
    def around(cls, nominal: float, below: float, above: float | None = None) -> Band:
        """From nominal - below to nominal + above (the same as below when left out)."""
        above = below if above is None else above
        return cls(nominal - below, nominal + above, below, above)

    @classmethod
    def at_most(cls, limit: float) -> Band:
        """Only an upper edge."""
        return cls(None, limit, 0.0, abs(limit))

    @classmethod
    def at_least(cls, limit: float) -> Band:
        """Only a lower edge."""
        return cls(limit, None, abs(limit), 0.0)

    def holds(self, value: float) -> bool:
        """True inside; the edges count as inside."""
        above_low = self.low is None or self.low <= value
        below_high = self.high is None or value <= self.high
        return above_low and below_high and value == value  # (NaN, where there is only one edge or none)

    def near(self, *values: float) -> bool:
        """True when any value lies within a fifth of the tolerance of an edge."""
        return any(self._near(value) for value in values)

    def _near(self, value: float) -> bool:
        near_low = self.low is not None and abs(value - self.low) <= NEAR * self.low_width
        near_high = self.high is not None and abs(value - self.high) <= NEAR * self.high_width
        return near_low or near_high


def unless_starved(finding: Finding, recording: Recording, off: float, per_s: float) -> Finding:
    """The finding, unless the machine's stalls explain it: `off` is how far the value lies outside of its tolerance.

    `per_s`: how fast the value changes with time. A node that is kept waiting goes on with its last command.
    """
    if finding.status is Status.FAILED and recording.stalls and off <= per_s * recording.stalled_s:
        return Finding(Status.ERROR, "The machine was too busy to judge this in wall time. Try again when it is not.")
    return finding

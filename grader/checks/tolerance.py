"""Decide whether a value is within its tolerance, or so near an edge that the trial must be repeated in wall time."""

from __future__ import annotations

from dataclasses import dataclass

NEAR = 0.2
"""A value is near an edge if its distance to the edge is at most this fraction of the tolerance."""


@dataclass(frozen=True)
class Band:
    """The values from `low` to `high`. `low_width` and `high_width` are the widths of the tolerance at these edges.

    If an edge is None, there is no limit on that side. NaN is never inside a band: every comparison with NaN except !=
    is False, so the methods check that a value is inside, and not that it is outside.
    """

    low: float | None
    high: float | None
    low_width: float = 0.0
    high_width: float = 0.0

    @classmethod
    def around(cls, nominal: float, below: float, above: float | None = None) -> Band:
        """Return the band from nominal - below to nominal + above (`above` defaults to `below`)."""
        above = below if above is None else above
        return cls(nominal - below, nominal + above, below, above)

    @classmethod
    def at_most(cls, limit: float) -> Band:
        """Return a band with only an upper edge."""
        return cls(None, limit, 0.0, abs(limit))

    @classmethod
    def at_least(cls, limit: float) -> Band:
        """Return a band with only a lower edge."""
        return cls(limit, None, abs(limit), 0.0)

    def holds(self, value: float) -> bool:
        """Return whether the value is inside the band, including the edges of the band."""
        above_low = self.low is None or self.low <= value
        below_high = self.high is None or value <= self.high
        return above_low and below_high and value == value  # false for NaN, even without edges

    def near(self, *values: float) -> bool:
        """Return whether the distance of any value from an edge is at most a fifth of the tolerance."""
        return any(self._near(value) for value in values)

    def _near(self, value: float) -> bool:
        near_low = self.low is not None and abs(value - self.low) <= NEAR * self.low_width
        near_high = self.high is not None and abs(value - self.high) <= NEAR * self.high_width
        return near_low or near_high

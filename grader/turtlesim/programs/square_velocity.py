"""Drive around a square with sides of 2 m: pure functions that compute the velocity from the turtle's pose."""

from __future__ import annotations

import math
from dataclasses import dataclass

SIDE_M = 2.0
_FORWARD_M_S = 1.0
_TURN_RAD_S = 0.4
_NEAR_PER_S = 4.0
"""The gain (1/s): the speed is the remaining distance (m) or angle (rad) times the gain, up to the maximum speed. The
gain must not be too large, because the last pose that the node received may be a few frames old."""
_CLOSE_M = 0.002
_CLOSE_RAD = 0.001


@dataclass(frozen=True)
class Leg:
    """A side and the turn at its end. `x`, `y` (m) is the corner at the end, and `theta` (rad) is the direction."""

    x: float
    y: float
    theta: float
    turning: bool = False


def first(x: float, y: float, theta: float) -> Leg:
    """Return the first side of a square that begins at this pose."""
    return Leg(x + SIDE_M * math.cos(theta), y + SIDE_M * math.sin(theta), theta)


def follow(leg: Leg, x: float, y: float, theta: float) -> tuple[Leg, float, float]:
    """Return the current leg of a turtle at this pose, and the turtle's linear (m/s) and angular (rad/s) velocity.

    Each corner is computed from the previous corner and not from the pose, so that small errors do not accumulate.
    """
    if leg.turning:
        remaining = math.remainder(leg.theta + math.pi / 2 - theta, math.tau)
        if abs(remaining) <= _CLOSE_RAD:
            return follow(first(leg.x, leg.y, leg.theta + math.pi / 2), x, y, theta)
        return leg, 0.0, _limited(_NEAR_PER_S * remaining, _TURN_RAD_S)
    remaining = (leg.x - x) * math.cos(leg.theta) + (leg.y - y) * math.sin(leg.theta)
    if abs(remaining) <= _CLOSE_M:
        return follow(Leg(leg.x, leg.y, leg.theta, turning=True), x, y, theta)
    return leg, _limited(_NEAR_PER_S * remaining, _FORWARD_M_S), 0.0


def _limited(value: float, most: float) -> float:
    return max(-most, min(most, value))

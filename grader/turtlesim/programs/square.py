"""A square of 2 m, side by side: where the turtle is goes in, the velocity to drive with comes out. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass

SIDE_M = 2.0
_FORWARD_M_S = 1.0
_TURN_RAD_S = 0.4
_NEAR_PER_S = 4.0
"""Slower towards the end: remaining way (m, rad) times this (1/s). A pose that is some frames old then does no harm."""
_CLOSE_M = 0.002
_CLOSE_RAD = 0.001


@dataclass(frozen=True)
class Leg:
    """A side, then the turn at its end. `x`, `y` (m) is the corner it leads to, `theta` (rad) its direction."""

    x: float
    y: float
    theta: float
    turning: bool = False


def first(x: float, y: float, theta: float) -> Leg:
    """The first side of a square that begins here."""
    return Leg(x + SIDE_M * math.cos(theta), y + SIDE_M * math.sin(theta), theta)


def follow(leg: Leg, x: float, y: float, theta: float) -> tuple[Leg, float, float]:
    """The leg for a turtle at this pose, and its linear (m/s) and angular velocity (rad/s).

    Corners are reckoned from the first one, so that small errors do not add up.
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

"""Shapes on the turtle's canvas, in metres, and how a shape is drawn in each role."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

Point = tuple[float, float]
Rgb = tuple[int, int, int]
Role = Literal["trajectory", "other", "expected", "fitted", "tick", "wall", "start"]

SIDE_M = 499 / 45
"""The largest coordinate on turtlesim's canvas (m): the last of 500 pixels, with 45 pixels per metre."""
SEA: Rgb = (69, 86, 255)
DEEP: Rgb = (16, 20, 84)


@dataclass(frozen=True)
class Look:
    """The appearance of a role: its colour, its line width, and the length of its dashes (m; 0 for a solid line)."""

    color: Rgb
    width_m: float
    dash_m: float = 0.0


LOOKS: dict[Role, Look] = {
    "trajectory": Look((179, 184, 255), 3 / 45),
    "other": Look((150, 226, 255), 2 / 45),
    "expected": Look((255, 214, 92), 0.045, 0.28),
    "fitted": Look((255, 255, 255), 0.028, 0.14),
    "tick": Look(DEEP, 0.035),
    "wall": Look((255, 92, 80), 0.07),
    "start": Look((255, 255, 255), 0.035),
}


@dataclass(frozen=True)
class Line:
    """A line through points (m), in the colour of its role or in another colour."""

    role: Role
    points: tuple[Point, ...]
    color: Rgb | None = None

    @property
    def look(self) -> Look:
        """The colour, width and dashes of the line."""
        look = LOOKS[self.role]
        return look if self.color is None else replace(look, color=self.color)


@dataclass(frozen=True)
class Ring:
    """A circle with its centre and radius in metres."""

    role: Role
    centre: Point
    radius: float


@dataclass(frozen=True)
class Arrow:
    """An arrowhead at a point (m) that points in the direction theta (rad)."""

    role: Role
    at: Point
    theta: float
    size_m: float = 0.28

    @property
    def corners(self) -> tuple[Point, ...]:
        """The four corners of the arrowhead (m): the tip, a side, the notch, and the other side."""
        corners = [(0.0, 1.0), (2.5, 0.6), (math.pi, 0.35), (-2.5, 0.6)]
        return tuple(
            (
                self.at[0] + self.size_m * r * math.cos(self.theta + a),
                self.at[1] + self.size_m * r * math.sin(self.theta + a),
            )
            for a, r in corners
        )

"""The start pose of the turtle: the usual pose of turtlesim, or a random pose from a seed, possibly within limits."""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING

from grader.errors import MachineError
from grader.trial.recording import Pose
from grader.turtlesim.turtle import SIDE_M, Start

if TYPE_CHECKING:
    from grader.exercise.model import StartLimits

MARGIN_M = 0.5
"""The minimum distance between the ideal path and a wall (m)."""
MOST_RADIUS_M = 2.8
"""The largest radius (m) of a circle for which a random start pose is drawn. With 2.95 m, the circles on both sides
only just fit between two opposite corners of the field, so almost every pose that is drawn has no room for them."""


def start_pose(seed: int | None, radius_m: float) -> Pose:
    """Return a start pose with room for a circle on either side, or turtlesim's start pose if there is no seed.

    `radius_m` is the radius of the ideal circle. There is room on both sides, so that a turtle that turns in the wrong
    direction does not also hit a wall.

    Raises:
        MachineError: the exercise has a circle with a radius of more than MOST_RADIUS_M, and there is a seed.
    """
    if seed is None:
        return Pose(*Start())
    if radius_m > MOST_RADIUS_M:
        message = (
            f"A random start pose needs a circle with a radius of at most {MOST_RADIUS_M:g} m, so that there is room "
            f"on both sides. The circle of this exercise has a radius of {radius_m:g} m. Give the start pose in "
            "exercise.toml, in [trial.start_pose]."
        )
        raise MachineError(message)
    draw = random.Random(seed)
    low, high = MARGIN_M + radius_m, SIDE_M - MARGIN_M - radius_m
    while True:
        x, y = draw.uniform(MARGIN_M, SIDE_M - MARGIN_M), draw.uniform(MARGIN_M, SIDE_M - MARGIN_M)
        theta = draw.uniform(-math.pi, math.pi)
        across = (-radius_m * math.sin(theta), radius_m * math.cos(theta))
        centres = [(x + side * across[0], y + side * across[1]) for side in (1, -1)]
        if all(low <= value <= high for centre in centres for value in centre):
            return Pose(round(x, 3), round(y, 3), round(theta, 3))


def start_within(limits: StartLimits, seed: int) -> Pose:
    """Return a random start pose within these limits."""
    draw = random.Random(seed)
    return Pose(*(round(draw.uniform(*pair), 3) for pair in (limits.x_m, limits.y_m, limits.theta_rad)))

"""Inputs: what the simulator itself does in a trial, drawn from the exercise's scenario and a seed."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from grader.trial.start_pose import MARGIN_M
from grader.turtlesim.turtle import FRAME_S, SIDE_M, Start, Turtle

if TYPE_CHECKING:
    from grader.exercise.model import Scenario
    from grader.trial.recording import Pose
    from grader.turtlesim.turtle import Pen, Rgb

MOST_DRAWS = 200
"""After this many draws, a trajectory that comes too close to a wall is accepted."""


@dataclass(frozen=True)
class Inputs:
    """`drives` holds start times (s) with speeds (m/s, rad/s). The others are those of the Scenario."""

    drives: tuple[tuple[float, float, float], ...] = ()
    rename: tuple[str, ...] = ()
    pose_every: int = 1
    pose_from_s: float = 0.0

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Inputs:
        """Create Inputs from the JSON data that dataclasses.asdict produced."""
        drives = tuple((from_s, linear, angular) for from_s, linear, angular in data["drives"])
        return cls(drives, tuple(data["rename"]), data["pose_every"], data["pose_from_s"])

    def drive(self, now_s: float) -> tuple[float, float] | None:
        """Return the speeds of the turtle at this time (m/s, rad/s); None before the first drive."""
        due = [(linear, angular) for from_s, linear, angular in self.drives if from_s <= now_s]
        return due[-1] if due else None


def draw_inputs(scenario: Scenario, start: Pose, seed: int) -> Inputs:
    """Draw random speeds until the trajectory stays at least 0.5 m away from every wall."""
    draw = random.Random(seed)
    inputs = Inputs((), scenario.rename, scenario.pose_every, scenario.pose_from_s)
    if not scenario.drives:
        return inputs
    for _ in range(MOST_DRAWS):
        drives = tuple(
            (each.from_s, round(draw.uniform(*each.linear_x_m_s), 3), round(draw.uniform(*each.angular_z_rad_s), 3))
            for each in scenario.drives
        )
        inputs = replace(inputs, drives=drives)
        if _keeps_clear(inputs, start, scenario.duration_s):
            break
    return inputs


class _NoPaper:
    """A canvas that draws nothing, because only the position of the turtle matters here."""

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        """Draw nothing."""

    def color_at(self, x: float, y: float) -> Rgb:  # noqa: ARG002
        """Return black."""
        return (0, 0, 0)


def _keeps_clear(inputs: Inputs, start: Pose, duration_s: float) -> bool:
    turtle, paper = Turtle(Start(start.x, start.y, start.theta)), _NoPaper()
    for frame in range(round(duration_s / FRAME_S) + 1):
        speed = inputs.drive(frame * FRAME_S)
        if speed is not None:
            turtle.command(speed[0], None, speed[1])
        turtle.update(FRAME_S, frame * FRAME_S, paper)
        if not all(MARGIN_M <= each <= SIDE_M - MARGIN_M for each in (turtle.x, turtle.y)):
            return False
    return True

"""Inputs: the drive commands, service calls and settings of a trial, from the exercise's scenario and a seed."""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from grader.trial.start_pose import MARGIN_M
from grader.trial.target_places import Target, draw_targets, to_withdraw
from grader.turtlesim.turtle import FRAME_S, SIDE_M, Start, Turtle

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.model import Scenario, Setting
    from grader.trial.recording import Pose
    from grader.turtlesim.turtle import Pen, Rgb

MOST_DRAWS = 200
"""After this number of random draws, the trajectory is accepted even if it is too close to a wall."""


@dataclass(frozen=True)
class PlannedCall:
    """A call that the trial makes to a service of the node, at the time `at_s` (s)."""

    at_s: float
    service: str
    type: str
    request: dict[str, Any]


@dataclass(frozen=True)
class Inputs:
    """The inputs of a trial.

    Each row of `drives` contains a start time (s) and the speeds from that time on (m/s, rad/s). `arguments` are
    additional ROS arguments of the node, `params_file` is the text of a file with parameters, and `targets` are the
    targets with their places. After the first catch, the trial withdraws the first target in `withdrawn` that has not
    been caught. All other fields have the same meaning as in Scenario.
    """

    drives: tuple[tuple[float, float, float], ...] = ()
    rename: tuple[str, ...] = ()
    pose_every: int = 1
    pose_from_s: float = 0.0
    answers_after_s: float = 0.0
    calls: tuple[PlannedCall, ...] = ()
    arguments: tuple[str, ...] = ()
    params_file: str = ""
    targets: tuple[Target, ...] = ()
    alone_s: float | None = None
    withdrawn: tuple[str, ...] = ()
    catch_from_s: float = 0.0

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Inputs:
        """Create Inputs from the JSON data that dataclasses.asdict produced."""
        drives = tuple((from_s, linear, angular) for from_s, linear, angular in data["drives"])
        calls = tuple(PlannedCall(**call) for call in data["calls"])
        targets = tuple(Target(**target) for target in data["targets"])
        lists = {
            "drives": drives,
            "calls": calls,
            "targets": targets,
            **{name: tuple(data[name]) for name in ("rename", "arguments", "withdrawn")},
        }
        return cls(**{**data, **lists})

    def drive(self, now_s: float) -> tuple[float, float] | None:
        """Return the speeds of the turtle at this time (m/s, rad/s), or None before the first drive."""
        due = [(linear, angular) for from_s, linear, angular in self.drives if from_s <= now_s]
        return due[-1] if due else None


def draw_inputs(scenario: Scenario, start: Pose, seed: int) -> Inputs:
    """Return the inputs of a trial, with random speeds and random places of targets.

    The speeds are drawn, at most MOST_DRAWS times, until they keep the turtle at least MARGIN_M away from every wall.
    """
    draw = random.Random(seed)
    targets = draw_targets(scenario.targets, start, seed) if scenario.targets else ()
    inputs = Inputs(
        rename=scenario.rename,
        pose_every=scenario.pose_every,
        pose_from_s=scenario.pose_from_s,
        answers_after_s=scenario.answers_after_s,
        calls=tuple(PlannedCall(call.at_s, call.service, call.type, dict(call.request)) for call in scenario.calls),
        arguments=tuple(part for each in _settings(scenario.parameters) for part in ("-p", each)),
        params_file=_params_file(scenario.params_file),
        alone_s=scenario.alone_s,
        targets=targets,
        withdrawn=to_withdraw(targets, start) if scenario.withdraws else (),
        catch_from_s=scenario.catch_from_s,
    )
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


def _settings(parameters: Mapping[str, Setting]) -> list[str]:
    """Return parameter assignments such as "radius:=2.0" for `--ros-args -p`."""
    return [f"{name}:={json.dumps(value)}" for name, value in parameters.items()]


def _params_file(parameters: Mapping[str, Setting]) -> str:
    """Return the text of a file for `--params-file` (JSON is also YAML), or an empty string if no file is needed."""
    return json.dumps({"/**": {"ros__parameters": dict(parameters)}}, indent=2) + "\n" if parameters else ""


class _NoPaper:
    """A canvas that draws nothing, because only the position of the turtle is needed."""

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

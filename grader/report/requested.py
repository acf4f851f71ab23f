"""Asked: what an exercise asks the turtle to drive, as shapes on the canvas."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeVar

from grader.checks.subjects.eight import Eight
from grader.checks.subjects.goal import Goal
from grader.checks.subjects.own import OwnCircle, own_circle_params
from grader.checks.subjects.path import CircleParams, expected_centre
from grader.checks.subjects.square import SIDES, Square
from grader.common.lazy import np
from grader.evidence.track import RESTS_M, STRAIGHT_RAD
from grader.report.shapes import Line, Point, Ring
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

GOAL_M = 0.3
"""The length of each of the four strokes that lead to a goal; the ring between them is what counts as arrived."""

P = TypeVar("P")


def asked_shapes(evidence: Evidence) -> tuple[tuple[Line | Ring, ...], str]:
    """The shapes that this trial asks for, and in words which they are; nothing where the way is free."""
    circle = asked_circle(evidence)
    if circle is not None:
        return (_ring(evidence.recording.start, circle),), f"asked for: radius {circle.radius_m:.2f} m"
    eight = params_of(evidence, "figure_eight", Eight)
    if eight is not None:
        return _eight(evidence, eight), f"asked for: two lobes of {eight.radius_m:.2f} m"
    square = params_of(evidence, "square", Square)
    if square is not None:
        return (Line("expected", _corners(evidence, square)),), f"asked for: sides of {square.side_m:.2f} m"
    goal = params_of(evidence, "goal", Goal)
    if goal is not None:
        return _goal(goal), f"asked for: x={goal.x_m:g} y={goal.y_m:g}"
    return (), ""


def asked_circle(evidence: Evidence) -> CircleParams | None:
    """The circle that the exercise asks for in this trial, the student's own where it does so; None without one."""
    own = params_of(evidence, "own_circle", OwnCircle)
    found = own_circle_params(evidence, own) if own is not None else None
    return found if isinstance(found, CircleParams) else params_of(evidence, "circle", CircleParams)


def params_of(evidence: Evidence, kind: str, params: type[P]) -> P | None:
    """The parameters of the first check of this kind of the trial that is not hidden; None without one."""
    for spec in evidence.exercise.checks:
        if spec.kind == kind and spec.trial == evidence.trial.id and not spec.hidden:
            given: dict[str, Any] = dict(spec.params)
            return params(**given)
    return None


def _ring(start: Pose, params: CircleParams) -> Ring:
    return Ring("expected", expected_centre(start, params), params.radius_m)


def _eight(evidence: Evidence, params: Eight) -> tuple[Ring, ...]:
    begin = _begin(evidence)
    senses = ("counter-clockwise", "clockwise")
    return tuple(_ring(begin, CircleParams(radius_m=params.radius_m, sense=sense)) for sense in senses)


def _corners(evidence: Evidence, params: Square) -> tuple[Point, ...]:
    """The corners (m), the first one again at the end; the side that is free is the one that the turtle took."""
    begin = _begin(evidence)
    turn = evidence.track.turn[np.abs(evidence.track.turn) > STRAIGHT_RAD]
    taken = -1.0 if len(turn) and turn[-1] < 0.0 else 1.0
    side = {"clockwise": -1.0, "counter-clockwise": 1.0}.get(params.sense, taken)
    x, y, corners = begin.x, begin.y, [(begin.x, begin.y)]
    for number in range(SIDES):
        theta = begin.theta + side * number * math.pi / 2.0
        x, y = x + params.side_m * math.cos(theta), y + params.side_m * math.sin(theta)
        corners.append((x, y))
    return tuple(corners)


def _goal(params: Goal) -> tuple[Line | Ring, ...]:
    x, y = params.x_m, params.y_m
    rays = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
    near, far = params.tolerance_m, params.tolerance_m + GOAL_M
    cross = [Line("expected", ((x + near * a, y + near * b), (x + far * a, y + far * b))) for a, b in rays]
    return (Ring("expected", (x, y), params.tolerance_m), *cross)


def _begin(evidence: Evidence) -> Pose:
    """Where the turtle starts, looking the way that it first drives: it may have turned before."""
    start, track = evidence.recording.start, evidence.track
    if not track.finite:
        return start
    moving = np.flatnonzero(track.steps > RESTS_M)
    if not len(moving):
        return start
    at = moving[0]
    return Pose(start.x, start.y, math.atan2(track.y[at + 1] - track.y[at], track.x[at + 1] - track.x[at]))

"""The report shows the path that the exercise requires."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.report.expectations import requested_path, shapes_of
from grader.report.shapes import Line, Ring
from grader.tests.checks.made import every, evidence, legs, recording
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.exercise.model import CheckSpec
    from grader.tests.checks.made import Timed

NORTH = Pose(4.0, 5.0, math.pi / 2)
AHEAD = legs((20, 1.0, 0.0))


def in_challenge(trial: str, commands: list[Timed], start: Pose = NORTH) -> Evidence:
    """Return the evidence of a learner's path in one of the trials of step 07."""
    return evidence(recording(commands, start), exercise=find_exercise("07-challenges"), trial_id=trial)


def requested_shapes(given: Evidence) -> tuple[tuple[Line | Ring, ...], str]:
    path = requested_path(given)
    return ((), "") if path is None else (shapes_of(path), path.path)


def points(shape: Line | Ring) -> list[tuple[float, float]]:
    assert isinstance(shape, Line)
    return [(round(x, 6), round(y, 6)) for x, y in shape.points]


def test_a_circle_is_drawn_beside_the_pose_from_which_the_turtle_drove() -> None:
    driven = recording(every(0.5, 2.0, 1.0), Pose(4.0, 5.0, 0.0))
    assert requested_shapes(evidence(driven))[0] == (Ring("expected", (4.0, 7.0), 2.0),)
    late = recording([], Pose(4.0, 5.0, 0.0))
    frames = replace(late.frames, x=late.frames.x + 2.0)
    commands = recording(every(0.5, 2.0, 1.0)).commands
    moved = replace(late, frames=frames, commands=commands, interventions=("teleport_absolute",))
    assert requested_shapes(evidence(moved))[0] == (Ring("expected", (6.0, 7.0), 2.0),)


def test_the_lobes_of_a_figure_eight_are_left_and_right_of_the_start() -> None:
    shapes, reported = requested_shapes(in_challenge("eight", AHEAD))
    centres = [number for ring in shapes if isinstance(ring, Ring) for number in ring.centre]
    assert centres == pytest.approx([3.0, 5.0, 5.0, 5.0])
    assert reported == "two lobes, radius 1.00 m"


def test_a_square_is_drawn_on_the_side_to_which_the_turtle_turned() -> None:
    left, right = ((20, 1.0, 0.0), (10, 0.0, 1.6)), ((20, 1.0, 0.0), (10, 0.0, -1.6))
    corners = points(requested_shapes(in_challenge("square", legs(*left)))[0][0])
    assert corners == [(4.0, 5.0), (4.0, 7.0), (2.0, 7.0), (2.0, 5.0), (4.0, 5.0)]
    corners = points(requested_shapes(in_challenge("square", legs(*right)))[0][0])
    assert corners == [(4.0, 5.0), (4.0, 7.0), (6.0, 7.0), (6.0, 5.0), (4.0, 5.0)]


def test_a_turtle_that_turns_first_gets_a_rotated_square() -> None:
    quarter = math.pi / 2 / (10 * 0.096)
    corners = points(requested_shapes(in_challenge("square", legs((10, 0.0, quarter), (20, 1.0, 0.0))))[0][0])
    assert corners[:2] == [(4.0, 5.0), (2.0, 5.0)]


def test_a_goal_is_a_ring_as_large_as_its_tolerance() -> None:
    shapes, reported = requested_shapes(in_challenge("goal", AHEAD))
    assert shapes[0] == Ring("expected", (8.5, 2.5), 0.1)
    assert reported == "x=8.5 y=2.5"


@pytest.mark.parametrize("trial", ["eight", "square", "goal"])
@pytest.mark.parametrize("commands", [[], every(0.5, math.nan, 1.0)], ids=["none", "nan"])
def test_a_trial_without_a_usable_trajectory_still_shows_what_is_required(trial: str, commands: list[Timed]) -> None:
    assert requested_shapes(in_challenge(trial, commands))[0]


def test_the_path_of_a_hidden_check_is_not_drawn() -> None:
    given = in_challenge("goal", AHEAD)
    checks: tuple[CheckSpec, ...] = tuple(replace(check, hidden=True) for check in given.exercise.checks)
    assert requested_shapes(replace(given, exercise=replace(given.exercise, checks=checks))) == ((), "")

"""The turtle turns towards its goal the short way round."""

from __future__ import annotations

import math

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.short_turn import SHORT_TURN
from grader.tests.checks.made import NODE_FILE, TICK_S, evidence, found, legs, recording
from grader.trial.recording import Pose

START = Pose(6.0, 7.0, 3.0)
"""The goal is below the turtle, 99 degrees to the left: in the direction -pi / 2, on the other side of pi."""


def turn(*by_rad: float, start: Pose = START) -> Finding:
    """Return the finding about a turtle that turns by these angles, and then drives 4 m."""
    turns = [(10, 0.0, each / (10 * TICK_S)) for each in by_rad]
    given = recording(legs(*turns, (30, 4.0 / (30 * TICK_S), 0.0)), start)
    return found(SHORT_TURN, evidence(given), x_m=6.0, y_m=3.0)


SHORT = -math.pi / 2 - 3.0 + 2 * math.pi


@pytest.mark.parametrize("turns", [(SHORT,), (SHORT + 1.0, -1.0), (SHORT - math.pi,), (SHORT, 0.5, -0.5)])
def test_a_turtle_may_turn_too_far_and_may_drive_backwards(turns: tuple[float, ...]) -> None:
    assert turn(*turns).status is Status.PASSED


def test_the_long_way_round_is_reported_with_both_angles() -> None:
    finding = turn(SHORT - 2 * math.pi)
    assert (finding.status, finding.diagnosis) == (Status.FAILED, "long-way-round")
    assert finding.observed == (
        "At the start, the goal was 98 degrees to the left, but the turtle turned by 262 degrees to the right."
    )
    assert str(finding.where) == f"{NODE_FILE}:15"


def test_after_the_turtle_was_near_the_goal_its_turns_do_not_count() -> None:
    start = Pose(6.0, 7.0, -math.pi / 2 - 0.1)
    given = recording(legs((2, 0.0, 0.1 / (2 * TICK_S)), (30, 4.0 / (30 * TICK_S), 0.0), (20, 0.0, -3.0)), start)
    assert found(SHORT_TURN, evidence(given), x_m=6.0, y_m=3.0).status is Status.PASSED


def test_both_ways_are_right_if_the_goal_is_straight_behind() -> None:
    assert turn(math.pi, start=Pose(6.0, 7.0, math.pi / 2 + 0.1)).status is Status.PASSED
    assert turn(-math.pi, start=Pose(6.0, 7.0, math.pi / 2 + 0.1)).status is Status.PASSED


@pytest.mark.parametrize(("wrong_rad", "near"), [(2.1, True), (3.5, False)])
def test_a_turn_near_the_limit_is_for_wall_time_to_judge(wrong_rad: float, *, near: bool) -> None:
    assert turn(-wrong_rad, wrong_rad + SHORT).near_edge == near

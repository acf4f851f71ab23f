from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.errors import MachineError
from grader.exercise.model import StartLimits
from grader.trial.recording import Pose
from grader.trial.start_pose import MARGIN_M, MOST_RADIUS_M, start_pose, start_within
from grader.turtlesim.turtle import SIDE_M


def test_without_a_seed_the_turtle_starts_where_turtlesim_starts_it() -> None:
    assert start_pose(None, 2.0) == Pose(SIDE_M / 2, SIDE_M / 2, 0.0)


@given(st.integers(), st.floats(0.1, MOST_RADIUS_M))
def test_the_ideal_circle_of_either_side_keeps_clear_of_the_walls(seed: int, radius_m: float) -> None:
    start = start_pose(seed, radius_m)
    for side in (1.0, -1.0):
        centre = (
            start.x - side * radius_m * math.sin(start.theta),
            start.y + side * radius_m * math.cos(start.theta),
        )
        for value in centre:
            assert value - radius_m >= MARGIN_M - 0.01
            assert value + radius_m <= SIDE_M - MARGIN_M + 0.01


@given(st.integers(), st.floats(MOST_RADIUS_M, 5.5, exclude_min=True))
def test_a_circle_that_does_not_fit_on_both_sides_has_no_random_start(seed: int, radius_m: float) -> None:
    assert start_pose(None, radius_m) == start_pose(None, 2.0)
    with pytest.raises(MachineError, match="needs a circle with a radius of at most"):
        start_pose(seed, radius_m)


def test_a_seed_gives_the_same_start_again_and_another_one_another() -> None:
    assert start_pose(7, 2.0) == start_pose(7, 2.0)
    assert start_pose(7, 2.0) != start_pose(8, 2.0)


@given(st.integers())
def test_a_start_pose_is_within_its_limits(seed: int) -> None:
    start = start_within(StartLimits((4.0, 7.0), (5.0, 5.0), (2.8, 3.1)), seed)
    assert start == start_within(StartLimits((4.0, 7.0), (5.0, 5.0), (2.8, 3.1)), seed)
    assert 4.0 <= start.x <= 7.0
    assert start.y == 5.0
    assert 2.8 <= start.theta <= 3.1

from __future__ import annotations

import math

from grader.exercise.model import Drive, Scenario
from grader.trial.inputs import Inputs, draw_inputs
from grader.trial.recording import Pose
from grader.turtlesim.turtle import SIDE_M, Start

MIDDLE = Pose(*Start())
AHEAD = Scenario(10.0, (Drive(1.0, (0.5, 3.0), (0.0, 0.0)), Drive(2.0, (0.0, 0.0), (-1.0, 1.0))))


def test_the_same_seed_draws_the_same() -> None:
    assert draw_inputs(AHEAD, MIDDLE, 3) == draw_inputs(AHEAD, MIDDLE, 3)
    assert draw_inputs(AHEAD, MIDDLE, 3) != draw_inputs(AHEAD, MIDDLE, 4)


def test_speeds_lie_between_their_limits() -> None:
    for seed in range(20):
        (begin, linear, angular), (later, still, turning) = draw_inputs(AHEAD, MIDDLE, seed).drives
        assert (begin, later, angular, still) == (1.0, 2.0, 0.0, 0.0)
        assert 0.5 <= linear <= 3.0
        assert -1.0 <= turning <= 1.0


def test_a_trajectory_that_would_end_at_a_wall_is_drawn_again() -> None:
    near_wall = Pose(SIDE_M - 2.0, 5.0, 0.0)
    for seed in range(20):
        assert draw_inputs(AHEAD, near_wall, seed).drives[0][1] <= 1.6


def test_the_last_drive_that_is_due_counts() -> None:
    inputs = Inputs(((1.0, 2.0, 0.0), (2.0, 0.0, math.pi)))
    assert [inputs.drive(t_s) for t_s in (0.9, 1.0, 2.5)] == [None, (2.0, 0.0), (0.0, math.pi)]

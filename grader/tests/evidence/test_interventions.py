"""Test which movements count as interventions.

Whether a movement counts depends on the movement and not on the service that was called.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grader.evidence.interventions import moved_by
from grader.tests.checks.made import every, recording
from grader.tests.checks.shapes import teleported
from grader.trial.observed import MOST_GOALS, Goal

STEADY = recording(every(0.5, 2.0, 1.0))


@pytest.mark.parametrize("name", ["teleport_absolute", "teleport_relative", "rotate_absolute", "reset"])
def test_a_call_that_changed_nothing_moved_nothing(name: str) -> None:
    assert moved_by(replace(STEADY, interventions=(name,)), from_start=True) is None


@pytest.mark.parametrize("name", ["kill", "set_parameters"])
def test_a_call_that_removes_the_turtle_or_its_rules_always_counts(name: str) -> None:
    assert moved_by(replace(STEADY, interventions=("set_pen", name)), from_start=False) == name


def test_a_jump_counts_unless_it_comes_before_the_first_command_where_that_is_allowed() -> None:
    assert moved_by(teleported(STEADY), from_start=False) == "teleport_absolute"
    early = teleported(STEADY, at_s=0.1)
    assert moved_by(early, from_start=False) is None
    assert moved_by(early, from_start=True) == "teleport_absolute"


def test_a_turn_that_no_command_asked_for_counts() -> None:
    frames = STEADY.frames
    late = frames.t_s > 5.0
    angular = np.where(late, -1.0, frames.angular)
    theta = np.cumsum(angular) * 0.016
    linear = np.where(late, 0.0, frames.linear)
    turned = replace(frames, angular=angular, theta=theta, linear=linear)
    assert moved_by(replace(STEADY, frames=turned, interventions=("rotate_absolute",)), from_start=False) is not None


def test_without_a_call_nothing_else_can_have_moved_it() -> None:
    assert moved_by(replace(teleported(STEADY), interventions=("spawn", "set_pen")), from_start=True) is None


def test_the_walls_explain_where_a_turtle_stops_but_not_where_it_jumps() -> None:
    into_wall = recording(every(0.5, 2.0, 0.0))
    frames = into_wall.frames
    assert frames.wall.any()
    by_name = ("teleport_absolute",)
    assert moved_by(replace(into_wall, interventions=by_name), from_start=True) is None
    jumped = replace(frames, y=np.where(frames.t_s > 5.0, 0.0, frames.y))
    assert moved_by(replace(into_wall, frames=jumped, interventions=by_name), from_start=True) is not None


def test_a_goal_turns_the_turtle_even_at_the_speed_of_the_last_command() -> None:
    def with_goal(ended_s: float | None) -> str | None:
        goal = Goal(2.0, "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute", {}, ended_s=ended_s)
        made = replace(STEADY, goals=(goal,), interventions=("rotate_absolute",))
        return moved_by(made, from_start=False)

    assert (with_goal(2.0), with_goal(3.0), with_goal(None)) == (None, "rotate_absolute", "rotate_absolute")


def test_goals_that_are_not_in_the_recording_count() -> None:
    goals = (Goal(2.0, "/turtle2/rotate_absolute", "turtlesim/action/RotateAbsolute", {}),) * MOST_GOALS
    made = replace(STEADY, goals=goals, interventions=("rotate_absolute",))
    assert moved_by(made, from_start=False) == "rotate_absolute"


def test_where_other_turtles_may_be_removed_only_a_movement_counts() -> None:
    removed = replace(STEADY, interventions=("kill", "spawn", "set_parameters"))
    assert moved_by(removed, from_start=True, others_removed=True) is None
    again = replace(teleported(STEADY), interventions=("kill", "spawn"))
    assert moved_by(again, from_start=True, others_removed=True) == "kill"

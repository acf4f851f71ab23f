"""The goals in a recording."""

from __future__ import annotations

from dataclasses import replace

from grader.tests.checks.made import recording
from grader.trial.goals import GoalLog
from grader.trial.observed import MOST_GOALS, Goal
from grader.trial.recording_json import from_json, to_json
from grader.turtlesim.goal_event import TYPE, GoalEvent, What

ACTION = "/turtle1/rotate_absolute"


class Theta:
    """A replacement for the Goal of RotateAbsolute, without ROS 2."""

    theta = 1.5

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"theta": "float"}


def event(number: int, what: What) -> GoalEvent:
    return GoalEvent(ACTION, TYPE, bytes([number % 256, number // 256]), what, Theta())


def test_goals_survive_being_written_and_a_recording_without_them_is_still_read() -> None:
    goal = Goal(1.0, ACTION, TYPE, {"theta": 1.5}, "canceled", {"delta": 0.5}, 2.0, 1.1, 1.9)
    written = to_json(replace(recording([]), goals=(goal,)))
    assert from_json(written).goals == (goal,)
    del written["goals"]
    assert from_json(written).goals == ()


def test_a_flood_of_goals_is_cut_and_what_is_unknown_is_left_out() -> None:
    log = GoalLog(lambda: 1.0)
    log.add(event(1, "result requested"))
    assert {each.request["theta"] for each in log.goals} == set()
    for number in range(MOST_GOALS + 10):
        log.add(event(number, "accepted"))
        log.add(event(number, "aborted"))
    assert len(log.goals) == MOST_GOALS
    assert {each.status for each in log.goals} == {"aborted"}

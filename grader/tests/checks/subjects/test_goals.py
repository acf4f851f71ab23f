"""Goals of rotate_absolute: how they are sent and how they end."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.goals import AWAITS_RESULT, SENDS_GOALS, TYPE
from grader.evidence.interventions import ROTATE
from grader.tests.checks.goals import given, goal, stop
from grader.tests.checks.made import evidence, found, recording
from grader.tests.checks.told import told
from grader.trial.recording import Endpoint, Graph, ProcessEnd

if TYPE_CHECKING:
    from grader.trial.observed import Goal


@pytest.mark.parametrize(
    ("goals", "values", "diagnosis"),
    [
        ([goal(1.0, 80.0, 2.4)], {}, None),
        ([goal(1.0, 80.0 - 360.0, 2.4)], {}, None),
        ([goal(1.0, 83.0, 2.4)], {}, "wrong-goal"),
        ([goal(1.0, -80.0, 2.4)], {}, "wrong-sign"),
        ([goal(1.0, math.degrees(80.0), 2.4)], {}, "degrees"),
        ([goal(1.0, 80.0, 1.5, "aborted"), goal(1.5, 80.0, 3.0)], {}, "goal-replaced"),
        ([goal(1.0, 80.0, 2.6, "aborted")], {}, "goal-aborted-by-command"),
        ([goal(1.0, 80.0, 1.5, "aborted")], {}, "goal-aborted"),
        ([goal(1.0, 80.0, None, "executing")], {}, "goal-not-reached"),
        ([goal(1.0, 80.0, 2.0, "canceled", cancel_asked_s=2.0)], {}, "goal-not-reached"),
        ([goal(1.0, 80.0, 5.0, "canceled", cancel_asked_s=5.0)], {}, None),
        ([goal(1.0, 80.0, 2.4)], {"nth": 2}, "goal-not-sent"),
        ([goal(1.0, 80.0, 2.4, result_asked_s=None)], {"nth": 2}, "result-not-awaited"),
        ([goal(1.0, 80.0, 2.4), goal(3.0, 224.0, 5.0)], {"total": 2, "turn_deg": 144.0}, None),
        ([goal(1.0, 80.0, 2.4), goal(3.0, 144.0, 5.0)], {"total": 2, "turn_deg": 144.0}, "wrong-goal"),
        ([goal(1.0, 80.0, 2.4), goal(3.0, math.degrees(144.0), 5.0)], {"total": 2, "turn_deg": 144.0}, "degrees"),
        ([goal(1.0, 80.0, 2.4), goal(3.0, math.nan, 5.0)], {"total": 2, "turn_deg": 144.0}, "wrong-goal"),
        ([goal(1.0, math.inf, 2.4)], {}, "wrong-goal"),
    ],
)
def test_goals_count_in_order_with_their_headings(
    goals: list[Goal], values: dict[str, Any], diagnosis: str | None
) -> None:
    trial = given(*goals, calls=(stop(4.9),), commands=[(2.6, 0.0, 0.0)])
    finding = found(SENDS_GOALS, trial, heading_deg=80.0, **values)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


@pytest.mark.parametrize(
    ("name", "type_", "diagnosis"),
    [(ROTATE, TYPE, "goal-not-sent"), ("/rotate", TYPE, "action-name"), (ROTATE, "a/action/B", "action-type")],
)
def test_a_client_of_another_action_is_named(name: str, type_: str, diagnosis: str) -> None:
    end = Endpoint("subscription", "/draw_circle", f"{name}/_action/feedback", f"{type_}_FeedbackMessage")
    graphs = (Graph(0.0, ("/turtlesim", "/draw_circle"), (end,)),)
    assert found(SENDS_GOALS, given(graphs=graphs), heading_deg=80.0).diagnosis == diagnosis


def test_a_node_without_a_client_sends_no_goal() -> None:
    finding = found(SENDS_GOALS, evidence(recording([])), heading_deg=80.0)
    assert finding.diagnosis == "goal-not-sent"
    assert "ActionClient" in finding.cause


def test_the_result_of_each_reached_goal_is_asked_for() -> None:
    reached, cancelled = goal(1.0, 80.0, 2.4), goal(3.0, 80.0, 4.0, "canceled", result_asked_s=None)
    assert found(AWAITS_RESULT, given(reached, cancelled)).status is Status.PASSED
    forgotten = found(AWAITS_RESULT, given(reached, goal(5.0, 80.0, 6.0, result_asked_s=None)))
    assert forgotten.diagnosis == "result-not-awaited"


def about(*goals: Goal, **changes: Any) -> str:  # noqa: ANN401
    return told(
        found(SENDS_GOALS, given(*goals, calls=(stop(4.9),), **changes), heading_deg=80.0, total=2, turn_deg=30.0)
    )


FIRST, SECOND = goal(1.0, 80.0, 2.4), goal(3.0, 110.0, 3.6)
CANCELLED = goal(3.0, 110.0, 5.0, "canceled", cancel_asked_s=5.0)
UNASKED = goal(1.0, 80.0, 2.4, result_asked_s=None)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The turtle reached 2 goals.", [FIRST, SECOND], [FIRST]),
        ("The turtle reached 2 goals.", [FIRST, SECOND], [FIRST, CANCELLED]),
        ("The goals were right, and one was cancelled", [FIRST, CANCELLED], [FIRST, SECOND]),
        ("No goal arrived at /turtle1/rotate_absolute.", [], [FIRST]),
        ("The node sent 1 goal, and then no more.", [FIRST], [FIRST, SECOND]),
        ("The callback that receives the result must send the next goal.", [FIRST], [UNASKED]),
        ("The first response only says that the goal was accepted.", [UNASKED], [FIRST]),
        (
            "The goal sent at 3.0 s has theta=1.40 rad, which is 80 degrees.",
            [FIRST, goal(3.0, 80.0, 3.6)],
            [FIRST, SECOND],
        ),
        (
            "The goal sent at 3.0 s was not reached by the end: its status is canceled.",
            [FIRST, goal(3.0, 110.0, 3.6, "canceled", cancel_asked_s=3.5)],
            [FIRST, goal(3.0, 110.0, 5.0, "canceled", cancel_asked_s=5.0)],
        ),
        (
            "The node itself cancelled the goal.",
            [FIRST, goal(3.0, 110.0, 3.6, "canceled", cancel_asked_s=3.5)],
            [FIRST, goal(3.0, 110.0, None, "executing")],
        ),
        (
            "The node sent this goal too late.",
            [FIRST, goal(9.7, 110.0, None, "executing")],
            [FIRST, goal(3.0, 110.0, None, "executing")],
        ),
        (
            "The field theta is in radians. math.radians converts degrees to radians.",
            [goal(1.0, math.degrees(80.0), 2.4)],
            [goal(1.0, math.degrees(7.5), 2.4)],
        ),
        ("Angles increase to the left", [goal(1.0, -80.0, 2.4)], [goal(1.0, -70.0, 2.4)]),
        (
            "This heading is 40 degrees further to the left than the previous one. The exercise asks for 30 degrees",
            [FIRST, goal(3.0, 120.0, 3.6)],
            [FIRST, goal(3.0, 30.0, 3.6)],
        ),
        (
            "This heading is 40 degrees further to the right than the previous one. The exercise asks for 30 degrees",
            [FIRST, goal(3.0, 40.0, 3.6)],
            [FIRST, goal(3.0, 120.0, 3.6)],
        ),
        (
            "This heading is 1 degree further to the left than the previous one.",
            [FIRST, goal(3.0, 81.0, 3.6)],
            [FIRST, goal(3.0, 82.0, 3.6)],
        ),
        ("This heading is the same as", [FIRST, goal(3.0, 80.0, 3.6)], [FIRST, goal(3.0, 81.0, 3.6)]),
        ("A goal is an absolute heading, not a turn", [FIRST, goal(3.0, 30.0, 3.6)], [FIRST, goal(3.0, 120.0, 3.6)]),
    ],
)
def test_a_sentence_about_goals_is_true(words: str, true: list[Goal], near: list[Goal]) -> None:
    assert words in about(*true)
    assert words not in about(*near)


RESULT = "The callback that receives the result must send the next goal."
SIDE = "The node drove the turtle after this goal. When the drive has ended, the node must send the next goal."
ON = "After this goal, the node drove until the end of the trial. Which condition ends the drive?"


@pytest.mark.parametrize(
    ("times", "speed", "words"),
    [((), 1.0, RESULT), ((2.0,), 1.0, RESULT), ((5.0,), 0.0, RESULT), ((5.0,), 1.0, SIDE), ((5.0, 9.8), 1.0, ON)],
)
def test_a_goal_that_does_not_come_after_a_drive_is_not_sent_by_the_result(
    times: tuple[float, ...], speed: float, words: str
) -> None:
    reported = about(FIRST, commands=[(t_s, speed, 0.0) for t_s in times])
    assert [each for each in (RESULT, SIDE, ON) if each in reported] == [words]


def test_a_goal_that_the_end_of_the_node_cut_short_did_not_start_too_late() -> None:
    goals = (FIRST, goal(9.7, 110.0, None, "executing"))
    ended = about(*goals, end=ProcessEnd(by="itself", exit_code=0, t_s=9.8, stop_s=None))
    assert "The node exited on its own after 9.8 s. The goal sent at 9.7 s was not reached by the end" in ended
    assert "The node sent this goal too late." not in ended
    assert "exited" not in about(*goals)


def about_results(*goals: Goal) -> str:
    return told(found(AWAITS_RESULT, given(*goals)))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node asked for the result of 2 goals.", [FIRST, SECOND], [UNASKED, SECOND]),
        ("The node asks for the result of each goal.", [UNASKED, SECOND], [FIRST, SECOND]),
        ("The node never asked for the result of the goal sent at 1.0 s.", [UNASKED, SECOND], [FIRST, SECOND]),
        ("No goal arrived at /turtle1/rotate_absolute.", [], [goal(1.0, 80.0, None, "executing")]),
        (
            "The node never asked for the result of the goal sent at 3.0 s.",
            [goal(3.0, 80.0, None, "executing", result_asked_s=None)],
            [goal(3.0, 80.0, None, "executing")],
        ),
    ],
)
def test_a_sentence_about_results_is_true(words: str, true: list[Goal], near: list[Goal]) -> None:
    assert words in about_results(*true)
    assert words not in about_results(*near)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        (
            "This is the heading converted from degrees to radians twice. math.radians must be called only once.",
            [goal(1.0, math.radians(80.0), 1.4)],
            [goal(1.0, math.radians(81.0), 1.4)],
        ),
        ("theta=0.02 rad, which is 1 degree.", [goal(1.0, 1.2, 1.4)], [goal(1.0, 2.2, 1.4)]),
        ("theta=0.04 rad, which is 2 degrees.", [goal(1.0, 2.2, 1.4)], [goal(1.0, 1.2, 1.4)]),
    ],
)
def test_a_sentence_about_the_size_of_a_heading_is_true(words: str, true: list[Goal], near: list[Goal]) -> None:
    assert words in told(found(SENDS_GOALS, given(*true), heading_deg=80.0))
    assert words not in told(found(SENDS_GOALS, given(*near), heading_deg=80.0))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("This heading is the same as in the previous goal. The heading must change", 80.0, -80.0),
        ("This is the heading of the previous goal with the opposite sign.", -80.0, 80.0),
        ("Compare this heading with the one that the exercise asks for.", 30.0, 80.0),
    ],
)
def test_a_second_goal_is_compared_with_the_first(words: str, true: float, near: float) -> None:
    for degrees, is_told in ((true, True), (near, False)):
        trial = given(goal(1.0, 80.0, 2.4), goal(3.0, degrees, 5.0))
        assert (words in told(found(SENDS_GOALS, trial, heading_deg=-75.0, nth=2))) == is_told


@pytest.mark.parametrize(("theta", "told"), [(144.0, True), (7.0, False), (math.inf, False)])
def test_a_heading_of_many_turns_is_in_degrees(theta: float, *, told: bool) -> None:
    goals = (goal(1.0, 80.0, 2.4), goal(3.0, math.degrees(theta), 5.0))
    finding = found(SENDS_GOALS, given(*goals), heading_deg=80.0, total=2, turn_deg=144.0)
    words = "theta is in radians, and this is more than ten full turns. math.radians converts degrees to radians."
    assert (words in finding.cause) == told

"""Cancellation of a goal: the call, the response, and the goals afterwards."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.cancel import CANCELS_GOAL, NO_GOAL_AFTER, SAYS_WHETHER_ACTIVE
from grader.tests.checks.goals import CLIENT, given, goal, stop
from grader.tests.checks.made import NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.told import told
from grader.trial.observed import MOST_GOALS

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Goal


@pytest.mark.parametrize(
    ("goals", "diagnosis"),
    [
        ([goal(1.0, 80.0, 3.1, "canceled", cancel_asked_s=3.0)], None),
        ([goal(1.0, 80.0, 3.9, "canceled", cancel_asked_s=3.8)], "goal-goes-on"),
        ([goal(1.0, 80.0, 5.0)], "goal-goes-on"),
        ([goal(1.0, 80.0, None, "executing")], "goal-goes-on"),
        ([goal(1.0, 80.0, 3.1, "aborted"), goal(3.1, 0.0, 4.0)], "goal-replaced"),
        ([goal(1.0, 80.0, 2.0)], "goal-not-sent"),
        ([goal(1.0, 80.0, 2.9), goal(3.2, -80.0, 3.6, "canceled", cancel_asked_s=3.5)], None),
    ],
)
def test_a_goal_is_cancelled_in_time(goals: list[Goal], diagnosis: str | None) -> None:
    trial = given(*goals, calls=(stop(3.0), stop(3.4)))
    finding = found(CANCELS_GOAL, trial, service="/stop", type="std_srvs/srv/Trigger")
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


def test_a_call_without_a_response_cancels_nothing() -> None:
    trial = given(goal(1.0, 80.0, 5.0), calls=(stop(3.0, answered=False),))
    finding = found(CANCELS_GOAL, trial, service="/stop", type="std_srvs/srv/Trigger")
    assert finding.diagnosis == "no-response"


def test_no_goal_follows_a_cancelled_one() -> None:
    cancelled = goal(1.0, 80.0, 3.1, "canceled", cancel_asked_s=3.0)
    calls = (stop(3.0),)
    assert found(NO_GOAL_AFTER, given(cancelled, calls=calls), service="/stop").status is Status.PASSED
    again = given(cancelled, goal(3.1, 0.0, 5.0), calls=calls)
    assert found(NO_GOAL_AFTER, again, service="/stop").diagnosis == "goal-after-cancel"
    crowd = (goal(0.5, 0.0, 0.6, "aborted"),) * (MOST_GOALS - 1)
    flood = found(NO_GOAL_AFTER, given(*crowd, cancelled, calls=calls), service="/stop")
    assert flood.diagnosis == "goal-after-cancel"
    assert flood.observed.endswith("goals or more, and the recording may not contain all of them.")
    assert "or more" not in found(NO_GOAL_AFTER, again, service="/stop").observed


@pytest.mark.parametrize(
    ("success", "diagnosis"),
    [
        ((True, False), None),
        ((False, False), "wrong-response"),
        ((True, True), "wrong-response"),
    ],
)
def test_the_response_says_whether_there_was_a_goal(success: tuple[bool, bool], diagnosis: str | None) -> None:
    cancelled = goal(1.0, 80.0, 3.02, "canceled", cancel_asked_s=3.0)
    calls = tuple(replace(stop(t_s), response={"success": said}) for t_s, said in zip((3.0, 3.4), success, strict=True))
    assert found(SAYS_WHETHER_ACTIVE, given(cancelled, calls=calls), service="/stop").diagnosis == diagnosis


@pytest.mark.parametrize("ended_s", [2.95, 3.05])
def test_a_goal_that_ends_at_the_time_of_the_call_may_count_or_not(ended_s: float) -> None:
    for said in (True, False):
        call = replace(stop(3.0), response={"success": said})
        reached = given(goal(1.0, 80.0, ended_s), calls=(call,))
        assert found(SAYS_WHETHER_ACTIVE, reached, service="/stop").status is Status.PASSED


ACTIVE = goal(1.0, 80.0, 3.1, "canceled", cancel_asked_s=3.0)
ABORTED = goal(1.0, 80.0, 3.1, "aborted")


def about(*goals: Goal) -> str:
    trial = given(*goals, calls=(stop(3.0),))
    return told(found(CANCELS_GOAL, trial, service="/stop", type="std_srvs/srv/Trigger"))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The goal was cancelled.", ACTIVE, goal(1.0, 80.0, 3.9, "canceled", cancel_asked_s=3.8)),
        (
            "The goal was cancelled 0.9 s after the call.",
            goal(1.0, 80.0, 3.9, "canceled", cancel_asked_s=3.8),
            goal(1.0, 80.0, 3.9),
        ),
        ("After the call to /stop, the turtle continued to turn towards its goal.", goal(1.0, 80.0, 3.9), ACTIVE),
        ("The turtle was not following a goal when /stop was called.", goal(1.0, 80.0, 2.9), goal(1.0, 80.0, 3.9)),
        ("Until the service is called, the node must send the next goal", goal(1.0, 80.0, 2.9), goal(1.0, 80.0, 3.9)),
        ("The goal sent at 1.0 s was aborted. The node did not cancel the goal.", ABORTED, goal(1.0, 80.0, 3.1)),
        ("The node did not cancel the goal.", ABORTED, replace(ABORTED, cancel_asked_s=3.05)),
        ("The goal is cancelled within 0.5 s after a call to /stop.", goal(1.0, 80.0, 3.9), ACTIVE),
    ],
)
def test_a_sentence_about_a_cancelled_goal_is_true(words: str, true: Goal, near: Goal) -> None:
    assert words in about(true)
    assert words not in about(near)


def with_lines(lines: str, *goals: Goal) -> Evidence:
    source = f"{CLIENT}\n{lines}\n"
    return replace(given(*goals, calls=(stop(3.0),)), submission=submission({NODE_FILE: source}))


def after(*goals: Goal) -> str:
    return told(found(NO_GOAL_AFTER, with_lines("handle.get_result_async()", *goals), service="/stop"))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("No goal arrived after the call.", [ACTIVE], [ACTIVE, goal(3.5, 0.0, 5.0)]),
        ("The node sent another goal 0.5 s after the call.", [ACTIVE, goal(3.5, 0.0, 5.0)], [ACTIVE]),
        ("A cancelled goal also has a result", [ACTIVE, goal(3.5, 0.0, 5.0)], [ACTIVE]),
        ("After a call to /stop, the node sends no more goals.", [ACTIVE, goal(3.5, 0.0, 5.0)], [ACTIVE]),
        (
            "Not judged, because no goal was active when the service was called.",
            [goal(3.5, 0.0, 5.0)],
            [ACTIVE, goal(3.5, 0.0, 5.0)],
        ),
    ],
)
def test_a_sentence_about_the_goals_after_a_call_is_true(words: str, true: list[Goal], near: list[Goal]) -> None:
    assert words in after(*true)
    assert words not in after(*near)


def about_success(success: bool | None, *goals: Goal) -> str:
    call = stop(3.0, answered=success is not None)
    response = None if success is None else {"success": success}
    trial = given(*goals, calls=(replace(call, response=response),))
    return told(found(SAYS_WHETHER_ACTIVE, trial, service="/stop"))


@pytest.mark.parametrize("goals", [(ACTIVE,), ()])
def test_a_sentence_about_success_is_true(goals: tuple[Goal, ...]) -> None:
    right, wrong = about_success(bool(goals), *goals), about_success(not goals, *goals)
    was, other = ("was", "false") if goals else ("was not", "true")
    for words in (
        f"The turtle {was} following a goal at 3.0 s, but success was {other}.",
        "Set success in the callback of the service, before the goal is cancelled",
        "In the response from /stop, success is true if a goal was active, and false if not.",
    ):
        assert words in wrong
        assert words not in right
    assert "success was true if a goal was active, and false if not." in right
    assert "success was true if a goal was active, and false if not." not in wrong


def test_a_response_that_never_came_says_nothing_about_a_goal() -> None:
    assert "The node offers /stop, but it did not respond to the call." in about_success(None, ACTIVE)
    assert found(SAYS_WHETHER_ACTIVE, given(ACTIVE), service="/stop").diagnosis == "no-response"


@pytest.mark.parametrize(
    ("value", "ended_s", "told_so"),
    [("self.goal is not None", 3.2, True), ("True", 3.2, False), ("self.goal is not None", 9.0, False)],
)
def test_a_goal_that_has_ended_and_still_counts_is_told(value: str, ended_s: float, *, told_so: bool) -> None:
    source = CLIENT.replace("        self.timer", f"        response.success = {value}\n        self.timer", 1)
    made = recording([], goals=(goal(1.0, 80.0, ended_s),), calls=(stop(3.0), stop(3.4)))
    reported = told(success_of(evidence(made, submission({NODE_FILE: source}))))
    assert ("the node still counted it as active. When a goal has ended, discard its handle." in reported) == told_so
    assert ("but success was true." in reported) == (ended_s < 3.4)


def success_of(made: Evidence) -> Finding:
    return found(SAYS_WHETHER_ACTIVE, made, service="/stop")


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ("handle.get_result_async()\nprint(future.result().status)", True),
        ("handle.get_result_async()\nprint(future.result())", False),
        ("print(future.result())", True),  # no callback receives a result
    ],
)
def test_a_node_that_looks_at_the_status_or_gets_no_result_is_not_told_to_look(lines: str, *, told: bool) -> None:
    goals = (goal(1.0, 80.0, 3.1, "canceled", cancel_asked_s=3.0), goal(3.1, 0.0, 5.0))
    cause = found(NO_GOAL_AFTER, with_lines(lines, *goals), service="/stop").cause
    assert ("Which callback sends this goal? After a call to the service, no callback may send one." in cause) == told
    assert ("Check the status of the result." not in cause) == told

"""Goals of rotate_absolute: how they are sent and how they end, feedback in the log, cancellation, and a star."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.cancel import CANCELS_GOAL, NO_GOAL_AFTER, SAYS_WHETHER_ACTIVE
from grader.checks.subjects.feedback import LOG_FEEDBACK
from grader.checks.subjects.goals import AWAITS_RESULT, ROTATE, SENDS_GOALS, TYPE
from grader.checks.subjects.star import STAR
from grader.report.scene import scene_of
from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, TICK_S, evidence, found, frames, recording, submission
from grader.trial.observed import Call, Goal
from grader.trial.recording import Endpoint, Frames, Graph, LogLine, Pose
from grader.turtlesim.turtle import Start, normalize

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

CLIENT = NODE.replace(
    "        self.timer",
    f'        self.client = ActionClient(self, RotateAbsolute, "{ROTATE}")\n'
    "        self.client.send_goal_async(goal, self.heard)\n        self.timer",
)


def goal(t_s: float, degrees: float, ended_s: float | None = None, status: str = "succeeded", **more: Any) -> Goal:  # noqa: ANN401
    asked = {"result_asked_s": t_s, **more}
    return Goal(t_s, ROTATE, TYPE, {"theta": math.radians(degrees)}, status, {"delta": 0.0}, ended_s, **asked)  # type: ignore[arg-type]


def stop(t_s: float, *, answered: bool = True) -> Call:
    response = {"success": True} if answered else None
    return Call(t_s, "/stop", "std_srvs/srv/Trigger", {}, response, t_s if answered else None, by_trial=True)


def given(*goals: Goal, **changes: Any) -> Evidence:  # noqa: ANN401
    return evidence(recording(changes.pop("commands", []), goals=goals, **changes), submission({NODE_FILE: CLIENT}))


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


def turning(from_s: float, until_s: float) -> Frames:
    """Return the frames of a turtle that turns left at 1 rad/s between two times."""
    still = frames([], Pose(*Start()), DURATION_S)
    theta = [normalize(min(max(t_s - from_s, 0.0), until_s - from_s)) for t_s in still.t_s.tolist()]
    return replace(still, theta=still.theta * 0.0 + theta)


@pytest.mark.parametrize(
    ("times", "text", "diagnosis"),
    [
        ((0.5, 1.0, 1.5, 2.0, 2.5), "{:.2f} rad to go", None),
        ((1.5,), "{:.2f} rad to go", "feedback-not-logged"),
        ([0.2 + 0.016 * index for index in range(150)], "{:.2f} rad to go", "every-message"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "-{:.2f} rad to go", "wrong-sign"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "{:.1f} rad to go", "log-numbers"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "1.25 rad to go", "stale-feedback"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "1{:.2f} rad to go", "wrong-feedback"),
    ],
)
def test_the_log_says_how_far_it_is(times: list[float], text: str, diagnosis: str | None) -> None:
    lines = tuple(LogLine(t_s, "INFO", "node", text.format(3.0 - t_s)) for t_s in times)
    trial = given(goal(0.0, math.degrees(3.0), 3.0), goal(3.0, 170.0, 3.1), log=lines, frames=turning(0.0, 3.0))
    finding = found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go")
    assert finding.diagnosis == diagnosis


def test_feedback_without_a_callback_is_named() -> None:
    trial = evidence(
        recording([], goals=(goal(0.0, 80.0, 3.0),)), submission({NODE_FILE: CLIENT.replace(", self.heard", "")})
    )
    finding = found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go")
    assert finding.diagnosis == "feedback-not-logged"
    assert "feedback_callback" in finding.cause


def star(sides: int = 5, ticks: int = 10, turn: float = 144.0, more: int = 0) -> list[tuple[float, float, float]]:
    """Return the commands of a star of 2 m, at 0.2 m per tick.

    The commands also turn the turtle, since the frames are computed from the commands.
    """
    corner = math.radians(turn) / (4 * TICK_S)
    speeds = []
    for index in range(sides):
        speeds += [(2.0 / (10 * TICK_S), 0.0)] * ticks
        speeds += [(0.0, corner)] * 4 if index < sides - 1 else [(2.0 / (10 * TICK_S), 0.0)] * more
    speeds += [(0.0, 0.0)] * 10
    return [((index + 1) * TICK_S, *speed) for index, speed in enumerate(speeds)]


@pytest.mark.parametrize(
    ("commands", "diagnosis"),
    [
        (star(), None),
        (star(sides=4), "too-few-sides"),
        (star(sides=6), "drives-on"),
        (star(ticks=8), "side-length"),
        (star(more=4), "side-length"),
        (star(turn=130.0), "corner-angle"),
        ([], "not-moving"),
    ],
)
def test_a_star_is_measured(commands: list[tuple[float, float, float]], diagnosis: str | None) -> None:
    trial = given(commands=commands, interventions=("rotate_absolute",))
    finding = found(STAR, trial, side_m=2.0, heading_deg=0.0)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


def test_a_star_may_be_turned_by_goals_and_not_by_teleports() -> None:
    trial = given(commands=star(), interventions=("rotate_absolute", "teleport_absolute"))
    assert found(STAR, trial, side_m=2.0, heading_deg=0.0).diagnosis == "intervention"


def test_a_picture_of_a_turtle_that_only_turned_says_so() -> None:
    scene = scene_of(given(goal(0.0, math.degrees(3.0), 3.0), frames=turning(0.0, 3.0)))
    assert scene.notice == "The turtle only turned."
    assert "1 goal: 1 succeeded" in scene.facts
    assert scene_of(given()).notice == "The turtle did not move."


def test_a_star_needs_its_first_heading() -> None:
    finding = found(STAR, given(commands=star()), side_m=2.0, heading_deg=30.0)
    assert finding.diagnosis == "corner-angle"

"""The reasons why no goal arrives at an action, or why a goal is aborted."""

from __future__ import annotations

import math

import pytest

from grader.checks.causes.why_no_goal import why_aborted, why_no_goal
from grader.checks.subjects.goals import TYPE
from grader.evidence.interventions import ROTATE
from grader.tests.checks.made import NODE, NODE_FILE, evidence, recording, submission
from grader.trial.observed import Goal
from grader.trial.recording import Endpoint, Graph

CLIENT = NODE.replace(
    "        self.timer",
    f'        self.client = ActionClient(self, RotateAbsolute, "{ROTATE}")\n        {{line}}self.timer',
)
SENDS = "self.client.send_goal_async(goal)\n        "


@pytest.mark.parametrize(
    ("code", "cause"),
    [
        (NODE, "The node has no ActionClient."),
        (CLIENT.format(line=""), "Creating a client sends nothing. The client's method send_goal_async sends a goal."),
        (CLIENT.format(line=SENDS), ""),
    ],
)
def test_what_the_source_lacks_is_told(code: str, cause: str) -> None:
    given = evidence(recording([]), submission({NODE_FILE: code}))
    assert why_no_goal(given, ROTATE, TYPE).text == cause


@pytest.mark.parametrize(
    ("name", "type_", "cause"),
    [
        (ROTATE, TYPE, ""),
        (ROTATE, "a/action/B", f"The client has the type a/action/B. The action has the type {TYPE}."),
        (
            "/rotate",
            TYPE,
            "The client uses the name /rotate. The name of the action is /turtle1/rotate_absolute, which includes the",
        ),
    ],
)
def test_a_client_of_another_action_or_type_is_told(name: str, type_: str, cause: str) -> None:
    end = Endpoint("subscription", "/draw_circle", f"{name}/_action/feedback", f"{type_}_FeedbackMessage")
    graphs = (Graph(0.0, ("/turtlesim", "/draw_circle"), (end,)),)
    given = evidence(recording([], graphs=graphs), submission({NODE_FILE: CLIENT.format(line=SENDS)}))
    text = why_no_goal(given, ROTATE, TYPE).text
    assert text.startswith(cause)
    assert bool(text) == bool(cause)


def goal(t_s: float, ended_s: float, status: str = "aborted") -> Goal:
    return Goal(t_s, ROTATE, TYPE, {"theta": math.radians(80.0)}, status, {"delta": 0.0}, ended_s)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("second_s", "command_s", "observed", "cause"),
    [
        (2.0, None, "A second goal at 2.0 s aborted the goal sent at 1.0 s.", "An action of turtlesim executes one"),
        (
            None,
            2.0,
            "A velocity command at 2.0 s aborted the goal sent at 1.0 s.",
            "Any command aborts the goal, even one with only zeros. Publish nothing while the turtle follows a goal.",
        ),
        (3.0, 0.5, "The goal sent at 1.0 s was aborted.", ""),
        (None, 2.5, "The goal sent at 1.0 s was aborted.", ""),
    ],
)
def test_what_aborted_a_goal_happened_before_its_end(
    second_s: float | None, command_s: float | None, observed: str, cause: str
) -> None:
    goals = [goal(1.0, 2.0), *([] if second_s is None else [goal(second_s, second_s + 1.0, "succeeded")])]
    given = evidence(recording([] if command_s is None else [(command_s, 0.0, 0.0)], goals=tuple(goals)))
    said, why = why_aborted(given, goals, goals[0])
    assert (said, why.text.startswith(cause), bool(why.text)) == (observed, True, bool(cause))

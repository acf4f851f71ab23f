"""Made-up goals of rotate_absolute, and the evidence about a node that sent them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from grader.checks.subjects.goals import TYPE
from grader.evidence.interventions import ROTATE
from grader.tests.checks.made import NODE, NODE_FILE, evidence, recording, submission
from grader.trial.observed import Call, Goal

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

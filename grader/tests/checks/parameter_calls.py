"""Made-up calls of the parameter services of a node, and what a report prints about them."""

from __future__ import annotations

from typing import Any

from grader.checks.subjects.parameters import DECLARES, SETS
from grader.tests.checks.made import every, evidence, exercise, found, recording
from grader.tests.checks.told import told
from grader.trial.observed import Call

NODE = exercise().trials[0].node


def described(**changes: Any) -> Call:  # noqa: ANN401
    limits = [{"from_value": 0.2, "to_value": 3.0, "step": 0.0}]
    about = {"name": "radius", "type": 3, "description": "in m", "floating_point_range": limits, **changes}
    return Call(0.5, f"/{NODE}/describe_parameters", "", {}, {"descriptors": [about]}, 0.5, by_trial=True)


def was_set(value: float, *, successful: bool, reason: str = "") -> Call:
    request = {"parameters": [{"name": "radius", "value": {"type": 3, "double_value": value}}]}
    response = {"results": [{"successful": successful, "reason": reason}]}
    return Call(3.0, f"/{NODE}/set_parameters", "", request, response, 3.0, by_trial=True)


def about_described(call: Call | None, **changes: Any) -> str:  # noqa: ANN401
    made = recording(every(0.5, 2.0, 1.0), calls=() if call is None else (call,), **changes)
    return told(found(DECLARES, evidence(made), parameter="radius", at_least=0.2, at_most=3.0))


def about_set(call: Call, answer: str = "accepted", **changes: Any) -> str:  # noqa: ANN401
    made = recording(every(0.5, 2.0, 1.0), calls=(call,), **changes)
    return told(found(SETS, evidence(made), parameter="radius", value=1.0, answer=answer))

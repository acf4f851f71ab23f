"""Parameters: their descriptions, and the response of a node when a parameter is set."""

from __future__ import annotations

from typing import Any

import pytest

from grader.checks.subjects.arc import ARC
from grader.checks.subjects.parameters import DECLARES, SETS
from grader.tests.checks.made import every, evidence, exercise, found, recording
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


@pytest.mark.parametrize(
    ("changes", "diagnosis"),
    [
        ({}, None),
        ({"type": 0}, "parameter-undeclared"),
        ({"type": 2}, "parameter-type"),
        ({"description": " "}, "parameter-descriptor"),
        ({"floating_point_range": []}, "parameter-descriptor"),
        ({"floating_point_range": [{"from_value": 0.0, "to_value": 3.0}]}, "parameter-range"),
    ],
)
def test_a_parameter_needs_a_type_a_description_and_a_range(changes: dict[str, Any], diagnosis: str | None) -> None:
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=(described(**changes),)))
    assert found(DECLARES, given, parameter="radius", at_least=0.2, at_most=3.0).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("call", "answer", "diagnosis"),
    [
        (was_set(1.0, successful=True), "accepted", None),
        (was_set(1.0, successful=False, reason="no"), "refused", None),
        (was_set(1.0, successful=False), "refused", "no-reason"),
        (was_set(1.0, successful=True), "refused", "parameter-accepted"),
        (was_set(1.0, successful=False, reason="no"), "accepted", "parameter-refused"),
        (was_set(1.0, successful=False, reason="Callback returned an invalid type"), "accepted", "result-not-returned"),
        (was_set(2.0, successful=True), "accepted", "no-response"),
    ],
)
def test_a_value_is_accepted_or_refused_with_a_reason(call: Call, answer: str, diagnosis: str | None) -> None:
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=(call,)))
    assert found(SETS, given, parameter="radius", value=1.0, answer=answer).diagnosis == diagnosis


def test_several_values_are_accepted_or_refused_at_once() -> None:
    values = [("radius", 0.55), ("speed", 2.0)]
    request = {"parameters": [{"name": name, "value": {"type": 3, "double_value": value}} for name, value in values]}
    response = {"result": {"successful": True, "reason": ""}}
    call = Call(3.0, f"/{NODE}/set_parameters_atomically", "", request, response, 3.0, by_trial=True)
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=(call,)))
    asked: dict[str, Any] = {"parameter": "radius", "value": 0.55, "answer": "refused"}
    both = found(SETS, given, also=(("speed", 2.0),), **asked)
    assert both.diagnosis == "parameter-accepted"
    assert "radius = 0.55 and speed = 2" in both.observed
    assert found(SETS, given, **asked).diagnosis == "no-response"


@pytest.mark.parametrize(("successful", "diagnosis"), [(True, "parameter-not-followed"), (False, "wrong-radius")])
def test_a_path_that_does_not_follow_a_parameter_is_named(successful: bool, diagnosis: str) -> None:
    given = evidence(recording(every(0.1, 2.0, 1.0), calls=(was_set(1.0, successful=successful, reason="no"),)))
    assert found(ARC, given, radius_m=1.0, from_s=3.4).diagnosis == diagnosis

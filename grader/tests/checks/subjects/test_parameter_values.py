"""A node accepts a valid value of a parameter, and refuses another one with a reason."""

from __future__ import annotations

from typing import Any

import pytest

from grader.checks.subjects.parameters import SETS
from grader.tests.checks.made import NODE_FILE, every, evidence, found, recording, submission
from grader.tests.checks.parameter_calls import NODE, about_described, about_set, was_set
from grader.trial.observed import Call
from grader.trial.recording import ProcessEnd


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


@pytest.mark.parametrize(("reason", "end"), [("no", "1.0: no."), ("No.", "1.0: No."), ("", "1.0: no reason.")])
def test_a_reason_ends_with_one_full_stop(reason: str, end: str) -> None:
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=(was_set(1.0, successful=False, reason=reason),)))
    assert found(SETS, given, parameter="radius", value=1.0, answer="accepted").observed.endswith(end)


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


ENDED = ProcessEnd(by="itself", exit_code=0, t_s=3.2, stop_s=None)
BLOCKED = "no callback blocks it, and its parameter services are not turned off."


def refused(reason: str) -> Call:
    return was_set(1.0, successful=False, reason=reason)


UNSET = was_set(2.0, successful=True)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node accepted radius = 1.0.", was_set(1.0, successful=True), UNSET),
        ("The node did not respond when radius was set.", UNSET, was_set(1.0, successful=True)),
        ("A node responds only while it is spun, no callback blocks it", UNSET, refused("no")),
        ("The node refused radius = 1.0: no reason.", refused(""), refused("no")),
        ("Setting radius to 1.0 is accepted.", refused("no"), was_set(1.0, successful=True)),
        (
            "Only a declared parameter can be set.",
            refused("Invalid access to undeclared parameter(s): ['radius']"),
            refused("declare it"),
        ),
        (
            "The callback must return a SetParametersResult in every case. Without return, the callback",
            refused("Callback returned an invalid type"),
            refused("Callback says no"),
        ),
        (
            "The type of the default value is the type of the parameter. Write 2.0 instead of 2.",
            refused("Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'"),
            refused("no turtle of this type"),
        ),
        (
            "The range in the ParameterDescriptor does not contain this value.",
            refused("Parameter radius out of range. Min: 2.0, Max: 3.0, value: 1.0"),
            refused("Parameter radius is too small"),
        ),
        (
            "For every valid value, the callback must return SetParametersResult(successful=True).",
            refused("no turtle of this type"),
            refused("Parameter radius out of range. Min: 2.0, Max: 3.0, value: 1.0"),
        ),
    ],
)
def test_a_sentence_about_an_accepted_value_is_true(words: str, true: Call, near: Call) -> None:
    assert words in about_set(true)
    assert words not in about_set(near)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node refused radius = 1.0: no.", refused("no"), refused("")),
        ("The node refused radius = 1.0 without a reason.", refused(""), refused("no")),
        ("Set the field reason of the SetParametersResult to a sentence for the user.", refused(""), refused("no")),
        ("must return SetParametersResult(successful=False, ...)", was_set(1.0, successful=True), refused("")),
        ("Setting radius to 1.0 is refused with a reason.", refused(""), refused("no")),
    ],
)
def test_a_sentence_about_a_refused_value_is_true(words: str, true: Call, near: Call) -> None:
    assert words in about_set(true, "refused")
    assert words not in about_set(near, "refused")


@pytest.mark.parametrize(
    ("reason", "diagnosis"),
    [("Trying to set a read-only parameter: radius.", "parameter-range"), ("It is read-only.", "parameter-refused")],
)
def test_a_read_only_parameter_refuses_every_value(reason: str, diagnosis: str) -> None:
    made = recording(every(0.5, 2.0, 1.0), calls=(refused(reason),))
    finding = found(SETS, evidence(made), parameter="radius", value=1.0, answer="accepted")
    assert finding.diagnosis == diagnosis
    assert (finding.cause == "") == (diagnosis == "parameter-range")


def test_a_node_that_ended_blocks_nothing() -> None:
    for given in (about_set(UNSET, end=ENDED), about_described(None, end=ENDED)):
        assert "The node exited on its own after 3.2 s." in given
        assert BLOCKED not in given


STEP = "The range has the field step, so it allows only some of the values between its limits. Remove step."


@pytest.mark.parametrize(
    ("reason", "found_"),
    [
        ("The parameter value for radius is not close enough to a valid step.", True),
        ("Parameter radius out of range Min: 0.2, Max: 0.9", False),
    ],
)
def test_a_range_with_steps_is_told(reason: str, *, found_: bool) -> None:
    assert (STEP in about_set(refused(reason))) == found_
    assert ("The range in the ParameterDescriptor does not contain this value." in about_set(refused(reason))) != found_


CHECKS = """\
class Driver(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        return {value}
"""


@pytest.mark.parametrize(
    ("value", "line"),
    [
        ("[SetParametersResult(successful=True) for _ in parameters]", 7),
        ("SetParametersResult(successful=True), None", 7),
        ("[SetParametersResult(successful=True)]", 7),
        ("None", 4),
    ],
)
def test_a_list_of_results_is_not_one_result(value: str, line: int) -> None:
    calls = (was_set(1.0, successful=False, reason="Callback returned an invalid type"),)
    given = evidence(recording([], calls=calls), submission({NODE_FILE: CHECKS.format(value=value)}))
    finding = found(SETS, given, parameter="radius", value=1.0, answer="accepted")
    words = "one SetParametersResult for all its parameters, not a list or a tuple."
    assert (words in finding.cause, finding.diagnosis) == (line == 7, "result-not-returned")
    assert finding.where is not None
    assert finding.where.line == line


@pytest.mark.parametrize(
    ("maker", "told"), [("add_post_set_parameters_callback", True), ("add_on_set_parameters_callback", False)]
)
def test_a_callback_after_the_change_cannot_refuse_it(maker: str, *, told: bool) -> None:
    source = CHECKS.format(value="None").replace("add_on_set_parameters_callback", maker)
    given = evidence(recording([], calls=(was_set(1.0, successful=True),)), submission({NODE_FILE: source}))
    finding = found(SETS, given, parameter="radius", value=1.0, answer="refused")
    assert ("This callback is called after the change, so it cannot refuse a value." in finding.cause) == told

"""Parameters: their descriptions, and the response of a node when a parameter is set."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.arc import ARC
from grader.checks.subjects.parameters import DECLARES, SETS
from grader.tests.checks.made import NODE as NODE_SOURCE
from grader.tests.checks.made import NODE_FILE, every, evidence, exercise, found, recording, submission
from grader.tests.checks.told import told
from grader.trial.observed import Call
from grader.trial.recording import ProcessEnd

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.package import Submission

NODE = exercise().trials[0].node
RADIUS: dict[str, Any] = {"parameter": "radius", "at_least": 0.2, "at_most": 3.0}


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


@pytest.mark.parametrize(("successful", "diagnosis"), [(True, "parameter-not-followed"), (False, "wrong-radius")])
def test_a_path_that_does_not_follow_a_parameter_is_named(successful: bool, diagnosis: str) -> None:
    given = evidence(recording(every(0.1, 2.0, 1.0), calls=(was_set(1.0, successful=successful, reason="no"),)))
    assert found(ARC, given, radius_m=1.0, from_s=3.4).diagnosis == diagnosis


def test_the_next_change_at_the_end_of_an_arc_does_not_hide_the_cause() -> None:
    commands = [*every(0.1, 2.0, 1.0, until_s=6.0), *every(0.1, 2.0, 2.0, first_s=6.0)]
    calls = (was_set(1.0, successful=True, reason=""), replace(was_set(1.0, successful=True, reason=""), t_s=6.0))
    given = evidence(recording(commands, calls=calls))
    assert found(ARC, given, radius_m=1.0, from_s=3.4, until_s=6.0).diagnosis == "parameter-not-followed"


def about_described(call: Call | None, **changes: Any) -> str:  # noqa: ANN401
    made = recording(every(0.5, 2.0, 1.0), calls=() if call is None else (call,), **changes)
    return told(found(DECLARES, evidence(made), parameter="radius", at_least=0.2, at_most=3.0))


SILENT = replace(described(), response=None, answered_s=None)
ENDED = ProcessEnd(by="itself", exit_code=0, t_s=3.2, stop_s=None)
BLOCKED = "Something blocks the node's callbacks, or the node's parameter services are turned off."


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The parameter radius has a description and the range 0.2 to 3.0.", described(), described(description="")),
        ("The parameter radius is a float with a description and the range", described(description=""), described()),
        ("The node has no parameter radius.", described(type=0), SILENT),
        ("declare_parameter declares a parameter, with its default value", described(type=0), described(type=2)),
        ("The node did not respond when the trial asked for radius.", SILENT, described(type=0)),
        ("The node did not respond when the trial asked for radius.", None, described(type=0)),
        ("The parameter radius is not a float.", described(type=2), described(description="")),
        (
            "A default value without a decimal point makes the parameter an integer",
            described(type=2),
            described(type=4),
        ),
        ("The parameter radius has no description.", described(description=" "), described(floating_point_range=[])),
        ("A ParameterDescriptor has the fields description and", described(description=""), described(type=2)),
        ("The parameter radius has no range.", described(floating_point_range=[]), described(description="")),
        (
            "The range of radius is 0.0 to 3.0.",
            described(floating_point_range=[{"from_value": 0.0, "to_value": 3.0}]),
            described(floating_point_range=[]),
        ),
    ],
)
def test_a_sentence_about_a_description_is_true(words: str, true: Call | None, near: Call) -> None:
    assert words in about_described(true)
    assert words not in about_described(near)


def about_set(call: Call, answer: str = "accepted", **changes: Any) -> str:  # noqa: ANN401
    made = recording(every(0.5, 2.0, 1.0), calls=(call,), **changes)
    return told(found(SETS, evidence(made), parameter="radius", value=1.0, answer=answer))


def refused(reason: str) -> Call:
    return was_set(1.0, successful=False, reason=reason)


UNSET = was_set(2.0, successful=True)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node accepted radius = 1.0.", was_set(1.0, successful=True), UNSET),
        ("The node did not respond when radius was set.", UNSET, was_set(1.0, successful=True)),
        ("A node responds only while rclpy.spin is running. Something blocks", UNSET, refused("no")),
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


NAMES = NODE_SOURCE.replace("        self.timer", '        self.declare_parameter("Radius", 1.0)\n        self.timer')
UNKNOWN = replace(described(), response={"descriptors": []}, request={"names": ["speed"]})
REFUSED = was_set(1.0, successful=False, reason="Invalid access to undeclared parameter(s): []")


@pytest.mark.parametrize(("source", "found_"), [(NAMES, True), (NODE_SOURCE, False)])
def test_the_names_that_the_node_declares_are_told(source: str, *, found_: bool) -> None:
    package = submission({NODE_FILE: source})
    missing = told(found(DECLARES, about_calls(described(type=0), package), **RADIUS))
    first = "The name is the first argument of declare_parameter. The node declares Radius."
    assert (first in missing) == found_
    refused_ = told(found(SETS, about_calls(REFUSED, package), parameter="radius", value=1.0, answer="accepted"))
    assert ("Only a declared parameter can be set. The node declares Radius." in refused_) == found_


def test_a_request_for_another_parameter_says_nothing_about_this_one() -> None:
    made = recording(every(0.5, 2.0, 1.0), calls=(UNKNOWN, replace(described(), request={"names": ["radius"]})))
    assert found(DECLARES, evidence(made), **RADIUS).status is Status.PASSED


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


def about_calls(call: Call, package: Submission) -> Evidence:
    return evidence(recording(every(0.5, 2.0, 1.0), calls=(call,)), package)


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

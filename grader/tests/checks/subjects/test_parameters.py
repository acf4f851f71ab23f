"""Parameters: the descriptions and the names that the node declares."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.parameters import DECLARES, SETS
from grader.tests.checks.made import NODE as NODE_SOURCE
from grader.tests.checks.made import NODE_FILE, every, evidence, found, recording, submission
from grader.tests.checks.parameter_calls import about_described, described, was_set
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.package import Submission
    from grader.trial.observed import Call

RADIUS: dict[str, Any] = {"parameter": "radius", "at_least": 0.2, "at_most": 3.0}


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


SILENT = replace(described(), response=None, answered_s=None)


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


def about_calls(call: Call, package: Submission) -> Evidence:
    return evidence(recording(every(0.5, 2.0, 1.0), calls=(call,)), package)

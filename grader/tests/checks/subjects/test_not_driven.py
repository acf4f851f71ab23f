"""A node that catches targets without driving to them: it moves or removes them, or hides its calls."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.catching import CATCHES, WITHIN_REACH
from grader.tests.checks.made import found
from grader.tests.checks.subjects.test_catching import CALLS, FAR, NEAR, diagnosis, given
from grader.trial.observed import Track

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

REMOVED = {"kill": "The node called /kill.", "reset": "The node removed all targets itself, with /reset."}


@pytest.mark.parametrize("name", ["kill", "reset"])
def test_a_target_that_the_node_removed_itself_is_not_caught(name: str) -> None:
    finding = found(CATCHES, with_targets(given(interventions=(name,))))
    assert diagnosis(finding) == "not-driven"
    assert finding.observed == REMOVED[name]
    assert finding.cause == "Only the spawner may remove a target. Call its service /catch."


def test_a_call_that_is_not_in_the_recording_was_perhaps_made_from_afar() -> None:
    finding = found(WITHIN_REACH, given(calls=CALLS[:1]), service="/catch", reach_m=0.5)
    assert finding.observed == "far was removed, but the recording has no earlier call to /catch for it."
    assert finding.cause == "Did the node remove it without this call, or make more calls than a recording can hold?"
    assert "no earlier call" not in found(WITHIN_REACH, given(), service="/catch", reach_m=0.5).observed


def test_a_target_that_moved_is_not_caught() -> None:
    brought = Track("far", ((0.0, 9.0, 5.54, 0.0), (3.0, 7.2, 5.54, 0.0)), 3.4)
    assert found(CATCHES, with_targets(given(NEAR, FAR))).status is Status.PASSED
    finding = found(CATCHES, with_targets(given(NEAR, brought)))
    assert (diagnosis(finding), finding.observed) == ("not-driven", "The node moved far, which is a target.")
    assert finding.cause == "The turtle must drive to each target. Publish on /turtle1/cmd_vel only."
    assert "is a target" not in found(CATCHES, given(NEAR, brought)).observed
    assert found(CATCHES, given(NEAR, brought)).status is Status.PASSED, "a spawner may move its own targets"


def with_targets(made: Evidence) -> Evidence:
    """Return the same evidence for a trial whose targets belong to the grader."""
    trial = made.exercise.trials[0]
    targets = replace(trial, scenario=replace(trial.scenario, targets=2))
    return replace(made, exercise=replace(made.exercise, trials=(targets, *made.exercise.trials[1:])))

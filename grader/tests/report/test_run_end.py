"""The sentence of a page about how the node's process ended."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import pytest

from grader.evidence.evidence import Run
from grader.report.html_run import runs_of
from grader.report.scene import scene_of
from grader.tests.checks.made import evidence, good

if TYPE_CHECKING:
    from grader.exercise.model import TrialSpec


def end_of(by: Literal["itself", "SIGINT"], exit_code: int, out_of: str | None) -> str:
    end = replace(good().end, by=by, exit_code=exit_code, t_s=3.0, out_of=out_of)
    return runs_of([evidence(replace(good(), end=end))])[0].end


@pytest.mark.parametrize(("by", "when"), [("itself", " after 3.0 s"), ("SIGINT", "")])
def test_a_node_that_exceeded_a_limit_is_not_said_to_have_exited_on_its_own(
    by: Literal["itself", "SIGINT"], when: str
) -> None:
    words = f"The node was killed{when}, because it used all the memory that a node may use."
    assert end_of(by, -9, "memory") == words


def test_the_other_ends_have_an_exit_code_as_in_a_shell() -> None:
    assert end_of("itself", -9, None) == "The node exited on its own after 3.0 s, with exit code 137."
    assert end_of("SIGINT", 0, None) == "The node stopped on Ctrl-C, with exit code 0."


def test_a_simulator_that_ran_alone_is_not_said_to_be_a_node() -> None:
    alone = replace(evidence(good()).trial, executable="", node="")
    assert end_of_trial(alone) == "The simulator ran without a node."


def end_of_trial(trial: TrialSpec) -> str:
    """Return the sentence for a recording of this trial."""
    given = evidence(good())
    return runs_of([replace(given, exercise=replace(given.exercise, trials=(trial,)))])[0].end


def test_a_run_that_was_not_finished_is_not_said_to_be_missing() -> None:
    given = evidence(good())
    assert scene_of(replace(given, runs={given.trial.id: Run()})).notice == "The node was not run."
    overwhelmed = replace(given, runs={given.trial.id: Run(overwhelmed="the simulator ended")})
    assert scene_of(overwhelmed).notice == "The trial could not be finished."

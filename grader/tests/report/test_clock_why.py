"""The reason for the clock, in a report on several nodes of which not all ran."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.exercises import find_exercise
from grader.evidence.evidence import Evidence, Run
from grader.report.report import report_of
from grader.submission.package import open_submission
from grader.tests.case import ROOT
from grader.tests.checks.made import recording


@pytest.mark.parametrize(
    ("ran", "why"),
    [
        ((), "The node was not run."),
        (("catcher",), "spawner was not run, but catcher was."),
        (("catcher", "game"), "spawner was not run, but catcher was."),
    ],
)
def test_a_report_does_not_deny_that_a_node_ran(ran: tuple[str, ...], why: str) -> None:
    exercise, submission = find_exercise("13-catch-them-all"), open_submission(ROOT / "solutions/13-catch-them-all")
    evidence = Evidence(exercise, submission, runs={id_: Run(recording=recording([])) for id_ in ran})
    assert report_of(evidence, (), "none", {}).clock_why == why


@pytest.mark.parametrize("ran", [("catcher",), ("spawner", "catcher")])
def test_the_reason_does_not_name_a_node_that_only_a_hidden_check_runs(ran: tuple[str, ...]) -> None:
    exercise, submission = find_exercise("13-catch-them-all"), open_submission(ROOT / "solutions/13-catch-them-all")
    checks = tuple(replace(spec, hidden=spec.hidden or spec.trial == "catcher") for spec in exercise.checks)
    made = {
        id_: Run(recording=replace(recording([]), clock="wall" if id_ == "catcher" else "simulated", why="it says so"))
        for id_ in ran
    }
    evidence = Evidence(replace(exercise, checks=checks), submission, runs=made)
    assert "catcher" not in report_of(evidence, (), "none", {}).clock_why

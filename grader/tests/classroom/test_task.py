from __future__ import annotations

import pytest

from grader.classroom.key import grader_key
from grader.classroom.task import Task, perform
from grader.exercise.private_checks import sources_of


@pytest.mark.parametrize(
    ("step", "diagnosis"), [("02-discover-topics", "no-answers-file"), ("03-circle-publisher", "no-package")]
)
def test_a_submission_without_a_package_has_no_points_and_a_reason(step: str, diagnosis: str) -> None:
    reason = "There is nothing in anna."
    task = Task("anna", "anna", sources_of({step}, None)[step], reason, grader=grader_key(), trusted=True)
    report = perform(task).report
    first, *others = report.outcomes
    assert (first.finding.diagnosis, first.finding.observed, report.points) == (diagnosis, reason, 0.0)
    assert {outcome.status.value for outcome in others} == {"skipped"}

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.classroom.key import grader_key
from grader.classroom.refused import Refused
from grader.classroom.task import Task, perform, set_aside
from grader.exercise.private_checks import sources_of

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis


@pytest.mark.parametrize(
    ("step", "diagnosis"), [("02-discover-topics", "no-answers-file"), ("03-circle-publisher", "archive-damaged")]
)
def test_a_submission_that_cannot_be_read_has_no_points_and_a_reason(step: str, diagnosis: Diagnosis) -> None:
    reason = "There is nothing in anna."
    refused = Refused(reason, diagnosis)
    task = Task("anna", "anna", sources_of({step}, None)[step], refused, grader=grader_key(), trusted=True)
    report = perform(task).report
    first, *others = report.outcomes
    assert (first.finding.diagnosis, first.finding.observed, report.points) == (diagnosis, reason, 0.0)
    assert {outcome.status.value for outcome in others} == {"skipped"}


def test_the_report_names_notebooks_that_were_not_used_and_takes_no_points_for_them() -> None:
    step, remark = "03-circle-publisher", "The cells of b.ipynb were not used."
    task = Task("anna", "anna", sources_of({step}, None)[step], {}, remark=remark, grader=grader_key(), trusted=True)
    first, *others = set_aside(task, "The machine failed.").report.outcomes
    assert (first.id, first.finding.observed, first.max, first.advice) == ("notebook", remark, 0.0, True)
    assert "notebook" not in {outcome.id for outcome in others}

"""The hidden checks in the formats that students may read."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Outcome, Status
from grader.report.github import to_annotations, to_summary
from grader.report.gradescope import to_gradescope
from grader.report.hidden import for_students
from grader.report.junit import to_junit
from grader.submission.where import Where
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from grader.report.report import Report


def with_hidden(status: Status) -> Report:
    """Return a report with an additional hidden check."""
    finding = Finding(
        status, "secret seen", "secret expected", "secret cause", "secret-diagnosis", Where("secret.py", 7)
    )
    outcome = Outcome("secret-id", "circle", "secret title", 0.0, 9.0, finding, hidden=True)
    made = report("passed")
    return replace(made, outcomes=(*made.outcomes, outcome))


@pytest.mark.parametrize("status", list(Status))
def test_students_see_only_whether_a_hidden_check_passed(status: Status) -> None:
    given = with_hidden(status)
    rows = [("anna", given)]
    texts = {
        "junit": to_junit(rows).decode(),
        "gradescope": to_gradescope(given),
        "summary": to_summary(rows),
        "annotations": to_annotations(rows, "src"),
    }
    assert [name for name, text in texts.items() if "secret" in text] == []
    said = {Status.PASSED: "passed", Status.ERROR: "could not be judged"}.get(status, "failed")
    assert for_students(given).outcomes[-1].finding.observed == f"Hidden check: {said}."
    assert for_students(given).points == given.points
    assert for_students(given).max == given.max

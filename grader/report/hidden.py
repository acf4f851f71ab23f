"""A report as students may see it: for a hidden check, the report shows only the result and the points.

Ids, titles and findings of hidden checks are left out.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.outcome import Finding, Status

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome
    from grader.report.report import Report


def for_students(report: Report) -> Report:
    """Return the report without the details of hidden checks, and without the changes with which causes were tested."""
    numbers = {outcome.id: number for number, outcome in enumerate((o for o in report.outcomes if o.hidden), 1)}
    return replace(
        report,
        outcomes=tuple(
            _covered(each, numbers[each.id]) if each.hidden else _without_change(each) for each in report.outcomes
        ),
    )


def _without_change(outcome: Outcome) -> Outcome:
    return replace(outcome, finding=replace(outcome.finding, change=""))


def _covered(outcome: Outcome, number: int) -> Outcome:
    # A hidden check that was skipped counts as failed, and the reason stays hidden too.
    status = Status.FAILED if outcome.status is Status.SKIPPED else outcome.status
    verdict = "passed" if status is Status.PASSED else "could not be judged" if status is Status.ERROR else "failed"
    return replace(
        outcome,
        id=f"hidden-{number}",
        kind="hidden",
        title="Hidden check",
        finding=Finding(status, f"Hidden check: {verdict}."),
    )

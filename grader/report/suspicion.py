"""Find submissions that an instructor should look at, because the grader could not judge or read them.

A fault of the machine hits submissions at random. A submission that the grader cannot judge again and again, while it
judges the others, may have been made to break the grader.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.outcome import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.report.report import Report

ERRORS = "errors"
"""The key in a report of a class: how often in a row grading it ended with an error."""
REPEATED = 2
"""After this many errors in a row, chance is unlikely."""
UNREADABLE = "unreadable"
"""The diagnosis of a submission that the grader could not read completely."""


def suspicions(graded: Sequence[tuple[Report, int]]) -> list[str]:
    """Return for each (report, number of errors in a row) why an instructor should look at it; empty for most."""
    judged = sum(not report.with_status(Status.ERROR) for report, _ in graded)
    return [_suspicion(report, errors, judged) for report, errors in graded]


def _suspicion(report: Report, errors: int, judged: int) -> str:
    if report.with_status(Status.ERROR) and errors >= REPEATED and judged:
        return f"suspicious: it could not be judged {errors} times in a row, but other submissions could"
    if any(outcome.finding.diagnosis == UNREADABLE for outcome in report.outcomes):
        return "the grader could not read all of it"
    return ""

"""What an instructor should look at: submissions that the grader could not judge or read, while it could others.

A fault of the machine meets one submission and then another. One that the grader fails at again and again, while it
judges those beside it, may have been made for that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.outcome import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.report.report import Report

ERRORS = "errors"
"""The key of a class's report that says how often in a row it ended with an error."""
REPEATED = 2
"""So many errors in a row are no chance any more."""
UNREADABLE = "unreadable"
"""The diagnosis of what broke the grader while it was read."""


def suspicions(graded: Sequence[tuple[Report, int]]) -> list[str]:
    """For each report of a class and its number of errors in a row: why it should be looked at; empty where not."""
    judged = sum(not report.with_status(Status.ERROR) for report, _ in graded)
    return [_suspicion(report, errors, judged) for report, errors in graded]


def _suspicion(report: Report, errors: int, judged: int) -> str:
    if report.with_status(Status.ERROR) and errors >= REPEATED and judged:
        return f"suspicious: it could not be judged {errors} times in a row, while others could"
    if any(outcome.finding.diagnosis == UNREADABLE for outcome in report.outcomes):
        return "the grader could not read all of it"
    return ""

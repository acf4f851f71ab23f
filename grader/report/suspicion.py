"""Find submissions that an instructor should check: they could not be judged or read, or their student is uncertain.

Machine faults affect submissions at random. If the grader repeatedly fails to judge a submission but can judge other
submissions, the submission may have been designed to break the grader.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.outcome import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.report.report import Report

ERRORS = "errors"
"""In the reports of a class, the value of this key is the number of consecutive gradings that ended with an error."""
REPEATED = 2
"""The number of consecutive errors after which chance is an unlikely explanation."""
ATTENTION = {
    "unreadable": "the grader could not read the whole submission",
    "similar-names": "its name and another student id differ only in their spelling",
    "several-submissions": "there are several submissions with its name",
}
"""Maps a diagnosis to the reason why an instructor should check the submission."""


def suspicions(graded: Sequence[tuple[Report, int]]) -> list[str]:
    """Return one text per submission: the reason why an instructor should check the submission, or an empty string.

    `graded` contains the report of each submission, and the number of consecutive gradings that ended with an error.
    """
    judged = sum(not report.with_status(Status.ERROR) for report, _ in graded)
    return [_suspicion(report, errors, judged) for report, errors in graded]


def _suspicion(report: Report, errors: int, judged: int) -> str:
    if report.with_status(Status.ERROR) and errors >= REPEATED and judged:
        return f"suspicious: it could not be judged in {errors} consecutive attempts, but other submissions could"
    found = {outcome.finding.diagnosis for outcome in report.outcomes}
    return next((text for diagnosis, text in ATTENTION.items() if diagnosis in found), "")

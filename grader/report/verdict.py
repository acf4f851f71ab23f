"""The verdict on a submission in one line, for every format except the PNG image, which has its own title."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from grader.checks.outcome import Status
from grader.common.words import count

if TYPE_CHECKING:
    from grader.report.report import Report

UNCONFINED = (
    "The code ran without a sandbox, with limits on time, memory, processes and file size only: "
    "`grader doctor` says why."
)
UNKNOWN = "It is not known whether the code ran in a sandbox: the recording is from an earlier version of the grader."

Tone = Literal["passed", "failed", "error"]


def tone(report: Report) -> Tone:
    """Return the kind of verdict: "error" if a check could not be judged, or else "passed" or "failed"."""
    if report.with_status(Status.ERROR):
        return "error"
    return "failed" if report.exit_code else "passed"


def sandbox_note(report: Report) -> str:
    """Return a sentence if the code ran without a sandbox, or if this is not known, or else an empty string."""
    return {True: "", False: UNCONFINED, None: UNKNOWN}[report.confined]


def verdict(report: Report) -> str:
    """Return one or two sentences that say whether the submission passed, and with how many points."""
    points = f"{report.points:g} of {report.max:g} points"
    errors, failed = report.with_status(Status.ERROR), report.with_status(Status.FAILED)
    skipped = report.with_status(Status.SKIPPED)
    if errors:
        return f"Not finished: {count(len(errors), 'check')} could not be judged. {points} so far."
    if report.warnings:
        return f"Passed: {points}, with {count(len(report.warnings), 'warning')}: see the checks that did not pass."
    if not failed and not skipped:
        return f"Passed: {points}."
    if not failed:
        return f"Not passed: {points}, {count(len(skipped), 'check')} not judged."
    also = f", {len(skipped)} not judged because of that" if skipped else ""
    return f"Not passed yet: {points}, {count(len(failed), 'check')} failed{also}."

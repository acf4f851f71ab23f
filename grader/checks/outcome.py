"""The result of one check."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.cause import Cause
    from grader.checks.edit import Edit
    from grader.submission.where import Where


class Status(str, Enum):
    """The status of a check.

    `failed` means that the student's work is wrong. `error` means that the grader or the machine failed, so there are
    no points yet.
    """

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """The result of a check.

    `observed`, `expected` and `cause` are texts for a beginner, and `diagnosis` is a stable id.

    If `near_edge` is True, the result may be different in wall time, so the check is judged again in wall time. For
    example, a measured value is near the edge of its tolerance (see tolerance.py), or the node did not stop in
    simulated time.
    """

    status: Status
    observed: str
    expected: str = ""
    cause: str = ""
    diagnosis: str | None = None
    where: Where | None = None
    near_edge: bool = False
    fix: tuple[Edit, ...] = field(default=(), compare=False)
    """The change that would fix the mistake. The grader can test this change in a copy of the submission."""
    tried: str = ""
    """A text for students about a test of this change: the check passed, failed again, or failed at a later point.

    If `exercise.toml` sets `show_fix`, the text also contains the change.
    """
    change: str = ""
    """The change as a unified diff, if a test of the change confirmed the cause. Only instructors see this whole diff,
    because it is a part of the solution."""

    def because(self, cause: Cause) -> Finding:
        """Return the finding with this cause instead of its own cause."""
        return replace(self, diagnosis=cause.diagnosis, cause=cause.text, where=cause.where, fix=cause.fix)


def passed(observed: str, *, near_edge: bool = False) -> Finding:
    """Return the finding of a check that passed."""
    return Finding(Status.PASSED, observed, near_edge=near_edge)


def failed(observed: str, expected: str, cause: Cause, *, near_edge: bool = False) -> Finding:
    """Return the finding of a check that failed because of the student's work."""
    finding = Finding(Status.FAILED, observed, expected, near_edge=near_edge)
    return finding.because(cause)


@dataclass(frozen=True)
class Outcome:
    """A finding with the id, kind and points of its check.

    If `advice` is True, the check is worth no points and never makes the submission fail, whatever its status.
    """

    id: str
    kind: str
    title: str
    points: float
    max: float
    finding: Finding
    hidden: bool = False
    advice: bool = False

    @property
    def status(self) -> Status:
        """The status of the finding."""
        return self.finding.status

"""Outcome: the result of one check."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.submission.where import Where


class Status(str, Enum):
    """`failed`: the student's work is wrong. `error`: the grader or the machine failed; there are no points yet."""

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """What a check found: `seen`, `expected` and `cause` are sentences for a beginner; `diagnosis` is a stable id.

    `near_edge` is True when the measured value is within a fifth of the tolerance from its edge, or when the node did
    not stop in simulated time. Such a check is judged again in wall time.
    """

    status: Status
    seen: str
    expected: str = ""
    cause: str = ""
    diagnosis: str | None = None
    where: Where | None = None
    near_edge: bool = False


def passed(seen: str, *, near_edge: bool = False) -> Finding:
    """Return the finding of a check that passed."""
    return Finding(Status.PASSED, seen, near_edge=near_edge)


def failed(
    diagnosis: Diagnosis,
    seen: str,
    expected: str,
    cause: str = "",
    *,
    where: Where | None = None,
    near_edge: bool = False,
) -> Finding:
    """Return the finding of a check that failed because of the student's work."""
    return Finding(Status.FAILED, seen, expected, cause, diagnosis, where, near_edge)


@dataclass(frozen=True)
class Outcome:
    """A finding with the id, kind and points of its check.

    With `advice`, the finding is worth no points and never fails the submission, whatever its status.
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

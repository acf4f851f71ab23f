"""Outcome: what a check found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.submission.where import Where


class Status(str, Enum):
    """`failed`: the student's work is wrong. `error`: the grader or the machine is broken, no points yet."""

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """What a check says: one sentence each, for a beginner. `diagnosis` is the stable id of the cause.

    `near_edge`: the measured value lies within a fifth of a tolerance's edge, or the node did not stop under
    simulated time; so wall time must judge.
    """

    status: Status
    seen: str
    expected: str = ""
    cause: str = ""
    diagnosis: str | None = None
    where: Where | None = None
    near_edge: bool = False


def passed(seen: str, *, near_edge: bool = False) -> Finding:
    """A finding in the student's favour."""
    return Finding(Status.PASSED, seen, near_edge=near_edge)


def failed(
    diagnosis: str,
    seen: str,
    expected: str,
    cause: str = "",
    *,
    where: Where | None = None,
    near_edge: bool = False,
) -> Finding:
    """A fault of the student's work."""
    return Finding(Status.FAILED, seen, expected, cause, diagnosis, where, near_edge)


@dataclass(frozen=True)
class Outcome:
    """A finding with its check's id, kind and points.

    `advice`: the finding is worth nothing and fails no run, whatever its status.
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
        """The finding's status."""
        return self.finding.status

"""Outcome: what a check found. Report: all outcomes of one submission."""

from __future__ import annotations

from dataclasses import dataclass, field
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


@dataclass(frozen=True)
class Report:
    """All outcomes of one submission, and what is needed to make it again."""

    exercise: str
    exercise_title: str
    submission: str
    """The submission as the user named it."""
    digest: str
    """sha256 of the submission's files."""
    grader: str
    ros: str
    clock: str
    clock_why: str
    seed: int | None
    outcomes: tuple[Outcome, ...]
    seconds: dict[str, float] = field(default_factory=dict)
    """Wall time of each stage; not compared between two reports."""
    recording: str | None = None
    confined: bool = True
    """False where a student's code ran with resource limits only, outside of a sandbox."""
    exercise_digest: str = ""
    """sha256 of exercise.toml: the checks and numbers that this report was judged by."""

    @property
    def points(self) -> float:
        """The points of all checks together."""
        return sum(outcome.points for outcome in self.outcomes)

    @property
    def max(self) -> float:
        """The points of all checks if each had passed, those included that the machine could not judge.

        Else a submission that makes the grading fail in the right place would have all points of what is left.
        """
        return sum(outcome.max for outcome in self.outcomes)

    def with_status(self, status: Status) -> tuple[Outcome, ...]:
        """The outcomes with this status, advice left out."""
        return tuple(o for o in self.outcomes if o.status is status and not o.advice)

    @property
    def exit_code(self) -> int:
        """0 all passed, 1 some check did not pass, 3 the grader or the machine is broken."""
        if self.with_status(Status.ERROR):
            return 3
        return 1 if self.with_status(Status.FAILED) or self.with_status(Status.SKIPPED) else 0

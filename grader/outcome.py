"""Outcome: what a check found. Report: all outcomes of one submission."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum


class Status(str, Enum):
    """`failed`: the student's work is wrong. `error`: the grader or the machine is broken, costs no points."""

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"
    ERROR = "error"


@dataclass(frozen=True)
class Where:
    """A place in the submission: `file` relative to the package folder, `line` from 1."""

    file: str
    line: int | None = None


@dataclass(frozen=True)
class Finding:
    """What a check says: one sentence each, for a beginner. `diagnosis` is the stable id of the cause.

    `near_edge`: the measured value lies within a fifth of a tolerance's edge, so wall time must judge.
    """

    status: Status
    seen: str
    expected: str = ""
    cause: str = ""
    diagnosis: str | None = None
    where: Where | None = None
    near_edge: bool = False


@dataclass(frozen=True)
class Outcome:
    """A finding with its check's id, kind and points."""

    id: str
    kind: str
    title: str
    points: float
    max: float
    finding: Finding
    hidden: bool = False
    advice: bool = False


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

    @property
    def points(self) -> float:
        return sum(outcome.points for outcome in self.outcomes)

    @property
    def max(self) -> float:
        return sum(outcome.max for outcome in self.outcomes)

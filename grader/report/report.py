"""Report: all outcomes of one submission."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import grader
from grader.checks.outcome import Status

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence


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
    def warnings(self) -> tuple[Outcome, ...]:
        """Failed or skipped checks that cost nothing, where nothing else is missing; else none."""
        missing = (*self.with_status(Status.FAILED), *self.with_status(Status.SKIPPED))
        costs = any(outcome.max for outcome in missing) or self.max == 0 or self.with_status(Status.ERROR)
        return () if costs else missing

    @property
    def exit_code(self) -> int:
        """0 passed, 1 some check that is worth points did not pass, 3 the grader or the machine is broken."""
        if self.with_status(Status.ERROR):
            return 3
        missing = self.with_status(Status.FAILED) or self.with_status(Status.SKIPPED)
        return 1 if missing and not self.warnings else 0


def report_of(
    evidence: Evidence, outcomes: tuple[Outcome, ...], ros: str, seconds: dict[str, float], *, confined: bool = True
) -> Report:
    """Return the report on evidence that was judged. `ros` names the ROS 2, `seconds` is the time of each stage."""
    recording = evidence.run.recording
    return Report(
        exercise=evidence.exercise.id,
        exercise_title=evidence.exercise.title,
        submission=evidence.submission.name,
        digest=evidence.submission.digest,
        grader=grader.__version__,
        ros=ros,
        clock=recording.clock if recording else "none",
        clock_why=_why_this_clock(evidence),
        seed=recording.seed if recording else None,
        confined=confined,
        outcomes=outcomes,
        seconds=seconds,
        exercise_digest=evidence.exercise.digest,
    )


def _why_this_clock(evidence: Evidence) -> str:
    """Return why the first trial was judged under its clock, and which trials were judged under the other one."""
    first = evidence.run.recording
    if first is None:
        return "The node was not run." if evidence.run.overwhelmed is None else "The trial could not be finished."
    others = [(view.trial.executable, view.run.recording) for view in evidence.views()]
    differ = [(name, other) for name, other in others if other is not None and other.clock != first.clock]
    return "; ".join([first.why, *(f"{name} in {other.clock} time: {other.why}" for name, other in differ)])

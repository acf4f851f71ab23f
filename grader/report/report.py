"""Report: all outcomes of one submission."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import grader
from grader.checks.outcome import Finding, Outcome, Status
from grader.common.words import a_list, count, shorten
from grader.evidence.for_students import evidence_for_students

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


@dataclass(frozen=True)
class Report:
    """All outcomes of one submission, and how it was graded: the versions, the clock, the seed and the sandbox."""

    exercise: str
    exercise_title: str
    submission: str
    """The name of the submission, as the user gave it."""
    digest: str
    """The sha256 of the submission's files."""
    grader: str
    ros: str
    clock: str
    clock_why: str
    seed: int | None
    outcomes: tuple[Outcome, ...]
    seconds: dict[str, float] = field(default_factory=dict)
    """The wall time of each stage (s)."""
    recording: str | None = None
    confined: bool | None = True
    """False if the student's code ran outside a sandbox, with resource limits only. None if this is not known, because
    the report is about a recording from an earlier version of the grader."""
    exercise_digest: str = ""
    """The sha256 of the exercise.toml with which this report was made."""

    @property
    def points(self) -> float:
        """The points earned in all checks together."""
        return sum(outcome.points for outcome in self.outcomes)

    @property
    def max(self) -> float:
        """The maximum points of all checks together, including checks that the machine could not judge.

        If checks that could not be judged were left out, a submission could get full marks by preventing the grader
        from judging the checks that it would fail.
        """
        return sum(outcome.max for outcome in self.outcomes)

    def with_status(self, status: Status) -> tuple[Outcome, ...]:
        """Return the outcomes with this status, except those of checks that only give advice."""
        return tuple(o for o in self.outcomes if o.status is status and not o.advice)

    @property
    def warnings(self) -> tuple[Outcome, ...]:
        """The failed and skipped checks if none of them is worth points, else an empty tuple.

        The tuple is also empty if a check has the status `error`, or if the whole report is worth no points.
        """
        missing = (*self.with_status(Status.FAILED), *self.with_status(Status.SKIPPED))
        costs = any(outcome.max for outcome in missing) or self.max == 0 or self.with_status(Status.ERROR)
        return () if costs else missing

    @property
    def exit_code(self) -> int:
        """The exit code for the report.

        The code is 0 if the submission passed (perhaps with warnings), 1 if it did not pass, and 3 if the grader or the
        machine failed.
        """
        if self.with_status(Status.ERROR):
            return 3
        missing = self.with_status(Status.FAILED) or self.with_status(Status.SKIPPED)
        return 1 if missing and not self.warnings else 0


def report_of(
    evidence: Evidence,
    outcomes: tuple[Outcome, ...],
    ros: str,
    seconds: dict[str, float],
    *,
    confined: bool | None = True,
) -> Report:
    """Return the report on a submission, from its evidence and the outcomes of its checks.

    `ros` is the name of the ROS 2 installation, and `seconds` contains the wall time of each stage.
    """
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
        outcomes=(*_remark(evidence), *(_with_try(outcome, evidence) for outcome in outcomes)),
        seconds=seconds,
        exercise_digest=evidence.exercise.digest,
    )


def _remark(evidence: Evidence) -> tuple[Outcome, ...]:
    """If the cells of notebooks were not used, return an outcome, worth no points, that names these notebooks."""
    if not evidence.submission.remark:
        return ()
    expected = f"One notebook, {evidence.exercise.id}.ipynb, next to the files that you hand in."
    finding = Finding(Status.FAILED, evidence.submission.remark, expected)
    return (Outcome("notebook", "submission", "The cells of the notebook are used", 0.0, 0.0, finding, advice=True),)


PASSES = "With a fix for this cause, a copy of the submission passes the check."
FURTHER = "With a fix for this cause, the node gets further in a copy of the submission."
REFUTED = "The supposed cause was fixed in a copy of the submission, but the check still did not pass."


def _with_try(outcome: Outcome, evidence: Evidence) -> Outcome:
    """Return the outcome with the result of testing a fix for its cause. A cause whose fix did not help is removed."""
    finding, tries = outcome.finding, evidence.tries
    if outcome.status is not Status.FAILED:
        return outcome
    made = tries.of(outcome.id, finding.diagnosis)
    if made is None:
        return replace(outcome, finding=replace(finding, tried=""))
    if made.result == "refuted":
        return replace(outcome, finding=replace(finding, cause="", tried=REFUTED))
    tried = PASSES if made.result == "passes" else FURTHER
    if tries.behind and made is next(each for each in tries.made if each.result != "refuted"):
        tried += f" After this fix, {count(tries.behind, 'more mistake')} appeared."
    if evidence.exercise.show_fix:
        tried += f" The change: {shorten(_in_one_line(made.difference), 200)}"
    return replace(outcome, finding=replace(finding, tried=tried, change=made.difference))


def _in_one_line(difference: str) -> str:
    """Return the removed and added lines of a unified diff as one line of text."""
    lines = [line for line in difference.splitlines() if not line.startswith(("---", "+++", "@@"))]
    signs = {"-": "remove", "+": "write"}
    return "; ".join(f"{signs[line[0]]} {line[1:].strip()}" for line in lines if line[:1] in signs)


def _why_this_clock(evidence: Evidence) -> str:
    """Return why the first trial used its clock, and why any later trials used a different one.

    Students read this, so trials that only hidden checks use are left out.
    """
    evidence = evidence_for_students(evidence)
    first = evidence.run.recording
    if first is None and evidence.run.called is not None:
        return "No node was run. Your code was called, without a simulator."
    if evidence.run.bench is not None:
        return f"Your tests were run {count(len(evidence.run.bench.runs), 'time')}."
    if first is None:
        return _why_no_clock(evidence)
    others = [(view.trial.executable, view.run.recording) for view in evidence.views() if not view.trial.beside]
    differ = [(name, other) for name, other in others if other is not None and other.clock != first.clock]
    return "; ".join([first.why, *(f"{name} in {other.clock} time: {other.why}" for name, other in differ)])


def _why_no_clock(evidence: Evidence) -> str:
    """Return why the first trial has no clock, with the names of the nodes that ran in other trials."""
    if evidence.run.overwhelmed is not None:
        return "The trial could not be finished."
    own = evidence.trial.executable
    executables = [view.trial.executable for view in evidence.views() if view.run.recording is not None]
    ran = [name for name in dict.fromkeys(executables) if name != own]
    if not ran:
        return "The node was not run."
    return f"{own} was not run, but {a_list(ran)} {'was' if len(ran) == 1 else 'were'}."

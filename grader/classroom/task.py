"""A task (one submission to grade, in a form that any worker process can receive) and its result."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from grader.checks.cause import Cause
from grader.checks.exercises import exercise_from
from grader.checks.outcome import Finding, Outcome, Status, failed
from grader.classroom.build_turns import build_in_turn
from grader.classroom.key import grader_key
from grader.classroom.refused import Refused
from grader.colcon.shared_builds import SharedBuilds
from grader.errors import MachineError
from grader.evidence.for_students import evidence_for_students
from grader.grading.grade import Graded, grade
from grader.grading.options import Options
from grader.report.hidden import for_students
from grader.report.report import report_of
from grader.submission.package import Submission
from grader.trial.trial import Trial

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.diagnosis import Diagnosis
    from grader.exercise.model import Exercise
    from grader.exercise.private_checks import Sources
    from grader.grading.clock import ClockChoice
    from grader.report.report import Report
    from grader.trial.recording import Recording


Pace = Literal["waits", "works"]
_builds = cache(lambda: SharedBuilds(build_in_turn))


@dataclass(frozen=True)
class Task:
    """A submission, its exercise, and the options for grading.

    `content` contains the files of the submission, or why they cannot be read. `package` is the name of the package's
    folder. `grader` is the key of the grader that created the task. Only a worker with the same key may grade the task.
    """

    student: str
    owner: str
    """The student id whose individual numbers the submission must use."""
    sources: Sources
    content: dict[str, bytes] | Refused
    archive: str = ""
    """The sha256 of the archive from which `content` was read, or an empty string if it was read from a folder."""
    package: str = ""
    rejected: tuple[str, ...] = ()
    digest: str = ""
    executable: frozenset[str] = frozenset()
    remark: str = ""
    clock: ClockChoice = "auto"
    seed: int | None = None
    explain: bool = True
    trusted: bool = False
    grader: str = ""
    alike: str = ""
    """A message that lists the names with the same student id, or an empty string if there is only one name."""

    @property
    def name(self) -> tuple[str, str]:
        """The student and the exercise. In a run, each pair of student and exercise is unique."""
        return self.student, self.sources.id


@dataclass(frozen=True)
class Done:
    """A graded submission: its complete report, and its page without the details of hidden checks."""

    report: Report
    page: bytes


def perform(
    task: Task, tell: Callable[[str], None] = lambda _: None, now: Callable[[Pace], None] = lambda _: None
) -> Done:
    """Grade a task. `now` is called whenever a trial in wall time begins or ends.

    During such a trial, other submissions can use the processors.

    Raises:
        MachineError: the task was created by another version of the grader, or no sandbox is available.
    """
    if task.grader != grader_key():
        message = (
            f"A worker has a different version of the grader ({grader_key()} instead of {task.grader}). "
            "Update the worker and start it again."
        )
        raise MachineError(message)
    in_cell = _confined(trusted=task.trusted)
    exercise = exercise_from(task.sources)
    if isinstance(task.content, Refused):
        if task.content.diagnosis is None:
            return set_aside(task, task.content.reason)
        return _done(task, _refused(task, exercise, task.content.reason, task.content.diagnosis))

    class Waiting(Trial):
        """A trial that reports when a run in wall time begins and ends."""

        def run(self, package: str, executable: str, tree: bytes) -> Recording:
            if self._plan.clock != "wall":
                return super().run(package, executable, tree)
            now("waits")
            try:
                return super().run(package, executable, tree)
            finally:
                now("works")

    # Run one trial at a time: other submissions use the processors, and memory is calculated per submission.
    options = Options(in_cell=in_cell, clock=task.clock, seed=task.seed, explain=task.explain, trials_at_once=1)
    try:
        return _done(task, grade(exercise, _submission(task), options, tell, build=_builds(), trial=Waiting))
    except MachineError as error:  # the machine may still be able to grade other submissions
        return set_aside(task, str(error))


@cache
def _confined(*, trusted: bool) -> bool:
    from grader.sandbox import bubblewrap

    return bubblewrap.require(trusted=trusted)  # once per process, because the result does not change


def set_aside(task: Task, why: str) -> Done:
    """Return a result with the status `error` for a submission that could not be graded."""
    exercise = exercise_from(task.sources)
    return _done(task, _unjudged(task, exercise, Finding(Status.ERROR, why)))


def _submission(task: Task, files: dict[str, bytes] | None = None) -> Submission:
    return Submission(
        name=task.student,
        package_dir=Path("/") / (task.package or "submission"),
        files=files if files is not None else task.content if isinstance(task.content, dict) else {},
        rejected=task.rejected,
        digest=task.digest,
        executable=task.executable,
        student=task.owner,
        remark=task.remark,
    )


def _refused(task: Task, exercise: Exercise, reason: str, diagnosis: Diagnosis) -> Graded:
    """Return a result with 0 points for a submission that could not be read. The first outcome states the reason."""
    what = "a package" if exercise.package else "answers.toml"
    title = f"The submission contains {what}"
    expected = f"One folder with {what} in it, or a .zip or .tar.gz of this folder."
    first = failed(reason, expected, Cause(diagnosis))
    skipped = Finding(Status.SKIPPED, f'Not judged, because "{title}" did not pass.')
    return _unjudged(task, exercise, skipped, Outcome("submission", "submission", title, 0.0, 0.0, first))


def _unjudged(task: Task, exercise: Exercise, finding: Finding, *first: Outcome) -> Graded:
    from grader.checks.kinds import KINDS
    from grader.evidence.evidence import Evidence

    outcomes = [
        Outcome(spec.id, spec.kind, spec.title, 0.0, spec.points, finding, spec.hidden, KINDS[spec.kind].advice)
        for spec in exercise.checks
    ]
    evidence = Evidence(exercise, _submission(task, {}))
    return Graded(report_of(evidence, (*first, *outcomes), "none", {}), evidence, ())


def _done(task: Task, graded: Graded) -> Done:
    report = replace(graded.report, outcomes=(*_similar(task), *graded.report.outcomes))
    return _with_page(replace(graded, report=report))


def _with_page(graded: Graded) -> Done:
    from grader.report.html import html_page

    page = html_page(evidence_for_students(graded.evidence), for_students(graded.report))
    return Done(graded.report, page.encode("utf-8", "replace"))


def _similar(task: Task) -> tuple[Outcome, ...]:
    """Return an outcome without points if another submission has the same student id, or an empty tuple."""
    if not task.alike:
        return ()
    finding = failed(task.alike, "One spelling of each student id.", Cause("similar-names"))
    return (Outcome("name", "submission", "Only this submission has its student id", 0.0, 0.0, finding, advice=True),)

"""The scores that count in nbgrader's gradebook: manual grades, and scores that the grader has confirmed.

The output of an autograded cell comes from a kernel that runs student code, so the score of the cell is provisional.
For these cells, `autograde` writes 0 points and "needs manual grade" (unconfirmed.py). `grader gradebook sync` replaces
these 0 points with the grader's scores. A score without a result from the grader is withheld: it becomes 0 points, and
a person has to review it. Manual grades, extra credit and assignments of other courses stay unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.checks.outcome import Status
from grader.exercise.model import catalogue

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from grader.checks.outcome import Outcome
    from grader.classroom.results import Results
    from grader.report.report import Report

NOT_SYNCED = "not confirmed by `grader gradebook sync`"
NOT_JUDGED = "not judged by the grader"
NO_CHECK = "the grader has no check for this cell"

Name = tuple[str, str]
"""A student and an exercise."""


@dataclass(frozen=True)
class Unconfirmed:
    """The cells of a submission with 0 points until their scores are confirmed or graded by hand, and the reason.

    `checks` is empty if the reason is about the whole submission.
    """

    student: str
    step: str
    checks: tuple[str, ...]
    why: str


def withhold(grade: Any) -> None:  # noqa: ANN401 - nbgrader's Grade
    """Set a cell to 0 points until its score is confirmed or a person grades the cell.

    A manual grade and extra credit stay unchanged.
    """
    grade.auto_score = 0.0
    grade.needs_manual_grade = True


def withhold_unconfirmed(
    gradebook: Any,  # noqa: ANN401 - nbgrader's Gradebook
    results: Results,
    steps: Collection[str] = (),
    unread: Collection[Name] = (),
) -> list[Unconfirmed]:
    """Withhold every score that is not confirmed.

    Return the cells that are now worth 0 points: the result of `unconfirmed`.
    """
    for _, _, grade, _ in _doubts(gradebook, results, steps, unread):
        if grade.auto_score != 0.0 or grade.manual_score is None:
            withhold(grade)
    gradebook.db.commit()
    return unconfirmed(gradebook, results, steps, unread)


def unconfirmed(
    gradebook: Any,  # noqa: ANN401 - nbgrader's Gradebook
    results: Results,
    steps: Collection[str] = (),
    unread: Collection[Name] = (),
) -> list[Unconfirmed]:
    """Return the cells whose scores the grader has not confirmed, except those that were graded manually.

    `steps` selects the exercises. If `steps` is empty, all exercises are used. `unread` are submissions that could not
    be read this time, so their stored results do not count.
    """
    names: dict[tuple[str, str, str], list[str]] = {}
    for student, step, grade, why in _doubts(gradebook, results, steps, unread):
        if grade.manual_score is None:
            names.setdefault((student, step, why), []).append(grade.name)
    return [Unconfirmed(student, step, tuple(checks), why) for (student, step, why), checks in names.items()]


def _doubts(
    gradebook: Any,  # noqa: ANN401 - nbgrader's Gradebook
    results: Results,
    steps: Collection[str],
    unread: Collection[Name],
) -> Iterator[tuple[str, str, Any, str]]:
    """Yield tuples (student, exercise, nbgrader's grade, the reason why the grade is not confirmed)."""
    for student, step, submission in submissions_of(gradebook, steps):
        kept = None if (student, step) in unread else results.load(student, step)
        for grade in provisional_grades(submission):
            why = _doubt(grade, kept.report if kept else None)
            if why:
                yield student, step, grade, why


def submissions_of(gradebook: Any, steps: Collection[str]) -> Iterator[tuple[str, str, Any]]:  # noqa: ANN401
    """Yield (student, exercise, nbgrader's submission) for all submissions of the course's exercises."""
    wanted = [step for step in catalogue() if not steps or step in steps]
    assignments = {assignment.name: assignment for assignment in gradebook.assignments}
    for step in wanted:
        if step in assignments:
            for submission in sorted(assignments[step].submissions, key=lambda each: str(each.student.id)):
                yield submission.student.id, step, submission


def provisional_grades(submission: Any) -> list[Any]:  # noqa: ANN401 - nbgrader's SubmittedAssignment
    """Return the grades that autograde reads from the output of a kernel: the grades of code cells without solutions.

    The grades for the exercise's own notebook come first.
    """
    step = submission.assignment.name
    grades = []
    for notebook in sorted(submission.notebooks, key=lambda each: (each.name != step, each.name)):
        solutions = {cell.name for cell in notebook.notebook.solution_cells}
        grades += [each for each in notebook.grades if each.cell.cell_type == "code" and each.name not in solutions]
    return grades


def _doubt(grade: Any, report: Report | None) -> str:  # noqa: ANN401 - nbgrader's Grade
    """Return the reason why a score is not confirmed, or an empty string if it is confirmed."""
    if report is None:
        return NOT_SYNCED
    outcome = outcome_of(grade, report)
    if outcome is None:
        return NO_CHECK
    if outcome.status is Status.ERROR:
        return NOT_JUDGED
    waits = grade.needs_manual_grade and grade.manual_score is None
    return NOT_SYNCED if waits or grade.auto_score != outcome.points else ""


def outcome_of(grade: Any, report: Report) -> Outcome | None:  # noqa: ANN401 - nbgrader's Grade
    """Return the outcome for a cell of the exercise's own notebook, or None for any other cell."""
    if grade.notebook.name != report.exercise:
        return None
    return next((outcome for outcome in report.outcomes if outcome.id == grade.name), None)

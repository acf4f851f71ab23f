"""`grader gradebook sync`: write the scores that count.

Scores from a kernel are provisional. `sync` grades the submitted package in the sandbox and writes the scores to
nbgrader's gradebook through its API. A check that the grader cannot judge is worth 0 points and needs a manual grade
(confirmed.py). The points of a manual grade are never changed.
"""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NoReturn

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.classroom.found import Found
from grader.classroom.grade_class import Request, grade_found
from grader.classroom.refused import Refused
from grader.classroom.results import Results
from grader.common.words import a_list, shorten
from grader.errors import UnreadableError, UsageError
from grader.gradebook.confirmed import (
    Unconfirmed,
    outcome_of,
    provisional_grades,
    withhold_unconfirmed,
)
from grader.gradebook.failed_disk import failed_disk
from grader.gradebook.readable import time_of
from grader.gradebook.student_names import unclear
from grader.submission.handed_in import open_handed_in
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from datetime import datetime
    from pathlib import Path

    from grader.checks.diagnosis import Diagnosis
    from grader.classroom.results import Result
    from grader.exercise.model import Exercise
    from grader.gradebook.class_folders import ClassFolders


@dataclass(frozen=True)
class Synced:
    """The result of a sync: how many submissions have a result, how many scores changed, and what was not judged."""

    submissions: int
    changed: int
    kept: int
    """The number of manual grades, which stay unchanged."""
    unjudged: tuple[str, ...]
    elsewhere: tuple[str, ...]
    """The checks with points that have a result but no cell in the notebook, and are therefore not in the gradebook."""
    left_out: tuple[str, ...]
    """The reasons why entries in the folder of the submissions are not graded."""
    maxima: tuple[str, ...]
    """The cells whose maximum points have changed in the gradebook, each with the old and the new points."""
    unconfirmed: tuple[Unconfirmed, ...]
    """The cells without a confirmed score, and the submissions that were not graded or whose scores could not be
    written."""


def sync(
    folders: ClassFolders,
    steps: Sequence[str],
    *,
    jobs: int | None,
    checks: Path | None,
    trusted: bool,
    say: Callable[[str], None],
    tell: Callable[[str], None],
) -> Synced:
    """Grade the collected submissions that have no valid result yet, and write all scores to the gradebook.

    Raises:
        UsageError: nothing was collected, a step does not exist or is not in the gradebook, or another sync is running.
        MachineError: the machine cannot grade submissions or write scores. Scores that are not confirmed are set to 0
            points in this case too.
    """
    from sqlalchemy.exc import OperationalError, SQLAlchemyError

    wanted = [find_exercise(step).id for step in steps]
    submissions = folders.submissions(wanted)
    results = Results(folders.results)
    with folders.gradebook() as gradebook:
        _require_assignments(gradebook, {step for _, step in submissions})
        not_graded = folders.left_out(wanted, {assignment.name for assignment in gradebook.assignments})
        enrolled = {student.id for student in gradebook.students}
        # Withhold scores first, so that no provisional score remains if grading is interrupted.
        withhold_unconfirmed(gradebook, results, wanted)
    if not submissions:
        message = (
            f"{folders.course.submitted_directory} has no submissions{f' of {a_list(wanted)}' if wanted else ''} yet. "
            "Run `nbgrader collect STEP`, or copy submissions to this folder."
        )
        raise UsageError(message)
    doubtful = unclear({student for student, _ in submissions}, enrolled)
    # The scores of an id that is not in the gradebook would go to a new student.
    not_graded += tuple(why.reason for student, why in doubtful.items() if student not in enrolled)
    submissions = [each for each in submissions if each[0] in enrolled or each[0] not in doubtful]
    found, why = _readable(folders, submissions, doubtful)
    folders.results.parent.mkdir(exist_ok=True)
    request = Request((), folders.results, jobs=jobs, checks=checks, trusted=trusted)
    graded = grade_found(request, found, say, tell) if found else []
    tally: Counter[str] = Counter()
    elsewhere: dict[str, None] = {}
    maxima: dict[str, str] = {}
    with folders.gradebook() as gradebook:
        for result in graded:
            name = (result.student, result.report.exercise)
            try:
                elsewhere.update(dict.fromkeys(_write(gradebook, folders, result, tally, maxima)))
            except (SQLAlchemyError, ValueError) as error:
                # nbgrader raises a ValueError in place of the error of the database.
                for fault in (error, error.__context__):
                    if isinstance(fault, OperationalError):
                        raise fault from error  # another program has locked the database, or the disk is full
                # For example, the database cannot store a name that is not valid UTF-8.
                gradebook.db.rollback()
                why.setdefault(name, f"its scores could not be written: {_in_words(error)}")
        withheld = withhold_unconfirmed(gradebook, results, wanted, why)
    problems = [
        *(each for each in withheld if (each.student, each.step) not in why),
        *(Unconfirmed(student, step, (), reason) for (student, step), reason in why.items()),
    ]
    unjudged = tuple(result.student for result in graded if result.report.with_status(Status.ERROR))
    changed = tuple(f"{cell} ({points})" for cell, points in maxima.items())
    return Synced(
        len(graded), tally["changed"], tally["kept"], unjudged, tuple(elsewhere), not_graded, changed, tuple(problems)
    )


def _readable(
    folders: ClassFolders,
    submissions: Sequence[tuple[str, str]],
    doubtful: Mapping[str, Refused] = MappingProxyType({}),
) -> tuple[tuple[Found, ...], dict[tuple[str, str], str]]:
    """Return all submissions, and the reason for each submission that is not graded.

    `doubtful` maps the name of a folder to the reason why it is not clear which student the folder belongs to.
    """
    found: list[Found] = []
    why: dict[tuple[str, str], str] = {}
    for student, step in submissions:
        exercise, submitted = find_exercise(step), folders.submitted(student, step)
        if student in doubtful:
            why[student, step] = doubtful[student].reason.rstrip(".")
            found.append(Found(student, step, submitted, doubtful[student]))
            continue
        try:
            if submitted.is_symlink() or submitted.parent.is_symlink():
                _refuse_link(student)
            read(time_of, submitted)  # at an invalid time, nbgrader would stop
            _require_readable(submitted, exercise)
            found.append(Found(student, step, submitted.parent.resolve() / submitted.name))
        except Exception as error:
            # An error in a student's files must not stop the grading of other submissions.
            if failed_disk(error):
                raise
            why[student, step] = f"it could not be read ({_in_words(error)})"
            kind: Diagnosis = "submission-link" if isinstance(error, _LinkError) else "unreadable"
            reason = f"The submission could not be read ({_in_words(error)})."
            found.append(Found(student, step, submitted, Refused(reason, kind)))
    return tuple(found), why


def _require_readable(submitted: Path, exercise: Exercise) -> None:
    try:
        open_handed_in(submitted, exercise)
    except UnreadableError:
        raise
    except UsageError:
        return  # there is no package: the grader gives 0 points and the reason


class _LinkError(UnreadableError):
    """Raised if the folder of a student or of a submission is a symbolic link."""


def _refuse_link(student: str) -> NoReturn:
    message = f"the folder of {shorten(student)} is a symbolic link, which could lead to another student's work"
    raise _LinkError(message)


def _in_words(error: BaseException) -> str:
    """Return the message of the error's cause, or of the error if it has no cause, shortened to one line."""
    cause = error.__cause__ or error
    text = (cause.strerror if isinstance(cause, OSError) else str(cause)) or type(cause).__name__
    return shorten(text.rstrip("."), 120)


def _require_assignments(gradebook: Any, steps: set[str]) -> None:  # noqa: ANN401 - nbgrader has no types
    known = {assignment.name for assignment in gradebook.assignments if assignment.notebooks}
    missing = sorted(steps - known)
    if missing:
        message = f"{missing[0]} is not in the gradebook yet: run `nbgrader generate_assignment {missing[0]}` first."
        raise UsageError(message)


def _write(
    gradebook: Any,  # noqa: ANN401 - nbgrader's Gradebook
    folders: ClassFolders,
    result: Result,
    tally: Counter[str],
    maxima: dict[str, str],
) -> list[str]:
    """Write the scores of one submission. Return the checks with points that have no cell in the notebook.

    If private checks change the points of a check, the maximum of its cell changes too. `maxima` collects these cells.
    """
    student, step = result.student, result.report.exercise
    gradebook.update_or_create_student(student)
    timestamp = _time_of(folders.submitted(student, step))
    given = {} if timestamp is None else {"timestamp": timestamp}
    submission = gradebook.update_or_create_submission(step, student, **given)
    grades: dict[str, Any] = {}
    for grade in provisional_grades(submission):
        outcome = outcome_of(grade, result.report)
        if outcome is not None:
            grades[outcome.id] = grade
    without_cell = []
    for outcome in result.report.outcomes:
        grade = grades.get(outcome.id)
        if grade is None:
            without_cell += [outcome.id] if outcome.max else []
            continue
        name = f"{step} {outcome.id}"
        if grade.cell.max_score != outcome.max:
            maxima[name] = f"{grade.cell.max_score:g} to {outcome.max:g}"
            _change_maximum(gradebook, grade.cell, outcome.max)
        changed = grade.auto_score != outcome.points
        tally["changed"] += changed
        grade.auto_score = outcome.points  # 0 if the check could not be judged
        if grade.manual_score is None:
            grade.needs_manual_grade = outcome.status is Status.ERROR
        else:
            tally["kept"] += 1
            # If the score or the maximum has changed, the person who graded by hand should review the grade.
            grade.needs_manual_grade = grade.needs_manual_grade or changed or name in maxima
    gradebook.db.commit()
    _late(folders, student, step)
    return without_cell


def _change_maximum(gradebook: Any, cell: Any, points: float) -> None:  # noqa: ANN401 - nbgrader has no types
    """Change the maximum of a graded cell, and its checksum: `nbgrader autograde` refuses a cell with another one."""
    from nbgrader.api import MissingEntry

    from grader.gradebook.restore import checksum

    cell.max_score = points
    step = cell.notebook.assignment.name
    with suppress(MissingEntry):
        source = gradebook.find_source_cell(cell.name, cell.notebook.name, step)
        solution = any(each.name == cell.name for each in cell.notebook.solution_cells)
        source.checksum = checksum(source, points, solution=solution)


def _time_of(folder: Path) -> datetime | None:
    try:
        return read(time_of, folder)
    except UnreadableError:
        return None  # `_readable` has reported the error


def _late(folders: ClassFolders, student: str, step: str) -> None:
    """Make nbgrader recalculate the penalty for a late submission from the new scores."""
    from nbformat.v4 import new_notebook
    from nbgrader.preprocessors import AssignLatePenalties

    about = {"student": student, "assignment": step, "notebook": step, "db_url": folders.course.db_url}
    AssignLatePenalties(config=folders.config).preprocess(new_notebook(), {"nbgrader": about})  # type: ignore[no-untyped-call]

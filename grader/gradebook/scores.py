"""`grader gradebook sync` and `compare`: the scores that count, and where a kernel said otherwise.

What a kernel says of itself is provisional. These scores come from the submitted package itself, graded in the sandbox,
and go into nbgrader's gradebook through its API. A manual grade is never touched.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.classroom.found import Found
from grader.classroom.grade_class import Asked, grade_found
from grader.classroom.results import Results
from grader.errors import UsageError
from grader.exercise import find_exercise
from grader.gradebook.put_together import graded_folder
from grader.outcome import Status

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from grader.classroom.results import Result
    from grader.gradebook.folders import ClassFolders


@dataclass(frozen=True)
class Synced:
    """What sync did: `changed` scores of so many submissions; `unjudged` ones the machine could not grade."""

    submissions: int
    changed: int
    kept: int
    """Manual grades, which stand."""
    unjudged: tuple[str, ...]
    elsewhere: tuple[str, ...]
    """Checks that no cell of the notebook stands for: in the results, and not in the gradebook."""


@dataclass(frozen=True)
class Difference:
    """A check on which kernel and grader disagree; `kernel` is None where the notebook was not run to its end."""

    student: str
    step: str
    check: str
    kernel: float | None
    grader: float


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
    """Grade what was collected and not graded yet, and write every score into the gradebook.

    Raises:
        UsageError: nothing was collected, a step is not in the gradebook, or another sync is running.
        MachineError: nothing can be graded or written.
    """
    from nbgrader.api import Gradebook

    submissions = folders.submissions(steps)
    if not submissions:
        message = (
            f"Nothing was collected into {folders.course.submitted_directory} yet: `nbgrader collect STEP`, or copy."
        )
        raise UsageError(message)
    with Gradebook(folders.course.db_url, folders.course.course_id) as gradebook:
        _require_assignments(gradebook, {step for _, step in submissions})
    found = tuple(
        Found(
            student,
            step,
            graded_folder(find_exercise(step), folders.submitted(student, step), folders.handed_in(student, step)),
        )
        for student, step in submissions
    )
    folders.results.parent.mkdir(exist_ok=True)
    asked = Asked((), folders.results, jobs=jobs, checks=checks, trusted=trusted)
    graded = grade_found(asked, found, say, tell)
    tally: Counter[str] = Counter()
    elsewhere: dict[str, None] = {}
    with Gradebook(folders.course.db_url, folders.course.course_id) as gradebook:
        for result in graded:
            elsewhere.update(dict.fromkeys(_write(gradebook, folders, result, tally)))
    unjudged = tuple(result.student for result in graded if result.report.with_status(Status.ERROR))
    return Synced(len(graded), tally["changed"], tally["kept"], unjudged, tuple(elsewhere))


def compare(folders: ClassFolders, steps: Sequence[str]) -> list[Difference]:
    """Where the kernel that autograde ran and the grader disagree, of what both have graded."""
    kept = Results(folders.results)
    differences: list[Difference] = []
    for student, step in folders.submissions(steps):
        result = kept.load(student, step)
        said = _kernel_scores(folders.autograded(student, step))
        if result is None or said is None:
            continue
        differences += [
            Difference(student, step, outcome.id, said[outcome.id], outcome.points)
            for outcome in result.report.outcomes
            if outcome.id in said and outcome.status is not Status.ERROR and said[outcome.id] != outcome.points
        ]
    return differences


def _require_assignments(gradebook: Any, steps: set[str]) -> None:  # noqa: ANN401 - nbgrader has no types
    known = {assignment.name for assignment in gradebook.assignments if assignment.notebooks}
    missing = sorted(steps - known)
    if missing:
        message = f"{missing[0]} is not in the gradebook yet: run `nbgrader generate_assignment {missing[0]}` first."
        raise UsageError(message)


def _write(gradebook: Any, folders: ClassFolders, result: Result, tally: Counter[str]) -> list[str]:  # noqa: ANN401
    """Write one submission's scores; returns the checks that have no cell."""
    student, step = result.student, result.report.exercise
    gradebook.update_or_create_student(student)
    timestamp = folders.course.get_existing_timestamp(str(folders.submitted(student, step)))
    given = {} if timestamp is None else {"timestamp": timestamp}
    submission = gradebook.update_or_create_submission(step, student, **given)
    grades = {grade.name: grade for notebook in submission.notebooks for grade in notebook.grades}
    without_cell = []
    for outcome in result.report.outcomes:
        grade = grades.get(outcome.id)
        if grade is None:
            without_cell += [outcome.id] if outcome.max else []
        elif outcome.status is not Status.ERROR:
            changed = grade.auto_score != outcome.points
            tally["changed"] += changed
            tally["kept"] += grade.manual_score is not None
            grade.auto_score = outcome.points
            # Whoever graded by hand should look again where there is something new to see.
            grade.needs_manual_grade = changed if grade.manual_score is not None else False
    gradebook.db.commit()
    _late(folders, student, step)
    return without_cell


def _late(folders: ClassFolders, student: str, step: str) -> None:
    """Let nbgrader work out the penalty for a late submission anew, from these scores."""
    from nbformat.v4 import new_notebook
    from nbgrader.preprocessors import AssignLatePenalties

    about = {"student": student, "assignment": step, "notebook": step, "db_url": folders.course.db_url}
    AssignLatePenalties(config=folders.config).preprocess(new_notebook(), {"nbgrader": about})  # type: ignore[no-untyped-call]


def _kernel_scores(notebook: Path) -> dict[str, float | None] | None:
    """What each grade cell of an autograded notebook is worth by its own output; None without the notebook."""
    from nbformat import read
    from nbgrader.utils import determine_grade, is_grade

    if not notebook.is_file():
        return None
    cells = read(notebook, as_version=4).cells  # type: ignore[no-untyped-call]
    return {cell.metadata.nbgrader.grade_id: determine_grade(cell)[0] for cell in cells if is_grade(cell)}

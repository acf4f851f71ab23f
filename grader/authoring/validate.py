"""Validate the course for its authors: every exercise, its solution, its starting point and its lesson."""

from __future__ import annotations

import os
import re
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from grader.authoring.lesson_commands import command_problems
from grader.authoring.release import stale
from grader.checks.exercises import load_exercise
from grader.checks.outcome import Status
from grader.common.words import a_list, count, line_at
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.sandbox import bubblewrap
from grader.submission.package import open_answers, open_submission

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from concurrent.futures import Executor, Future
    from pathlib import Path

    import typer

    from grader.checks.outcome import Outcome
    from grader.exercise.model import Exercise
    from grader.report.report import Report

LESSON_WORDS = (1200, 2000)
_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
_CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)


def validate(
    names: list[str], app: typer.Typer, tell: Callable[[str], None] = lambda _: None, *, course: Path | None = None
) -> list[str]:
    """Return one message for each problem of the exercises in `names` (or of all exercises if `names` is empty).

    Files that are out of date in solutions/ or exercises/ are reported for all exercises.
    `app` is the command `grader`, whose parser checks the commands in the lessons. `tell` is called with progress
    messages. `course` is the folder course/. The default is the folder of this checkout or installation.

    Raises:
        UsageError: `names` contains a name that no exercise has.
    """
    course = course or course_folder()
    files = catalogue(course)
    unknown = [name for name in names if name not in files]
    if unknown:
        message = (
            f"The course has no exercise {a_list(unknown, 'or')}. "
            f"The exercises are {a_list(list(files), most=len(files))}."
        )
        raise UsageError(message)
    problems = _stale(course.parent)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        looked = [_Validation(name, files[name], course.parent, app, pool, tell) for name in names or files]
        for each in looked:
            problems += each.problems()
    return list(dict.fromkeys(problems))


def _stale(root: Path) -> list[str]:
    try:
        return [f"{line} Run: grader release" for line in stale(root / "solutions", root / "exercises")]
    except UsageError as error:  # for example, a notebook or an exercise.toml is invalid
        return [str(error)]


class _Validation:
    """Finds the problems of an exercise. The exercise's solution and starting point are graded in the background."""

    def __init__(
        self, name: str, file: Path, root: Path, app: typer.Typer, pool: Executor, tell: Callable[[str], None]
    ) -> None:
        self._name = name
        self._file = file
        self._root = root
        self._app = app
        self._tell = tell
        try:
            self._exercise = load_exercise(file)
        except UsageError as error:
            self._unreadable = str(error)
        else:
            self._unreadable = ""
            self._solution = pool.submit(self._graded, "solution", "solutions")
            self._starting_point = pool.submit(self._graded, "starting point", "exercises")

    def problems(self) -> Iterator[str]:
        """Yield one message per problem."""
        if self._unreadable:
            yield self._unreadable
            return
        if self._exercise.id != self._name:
            yield (
                f'{self._file}: [exercise]: "id" is "{self._exercise.id}"; it must be "{self._name}", the name of the '
                "folder."
            )
        if not self._exercise.hints:
            yield f"{self._file}: the file has no [[hint]]. Learners need hints."
        elif all(hint.checks for hint in self._exercise.hints):
            helped = {check for hint in self._exercise.hints for check in hint.checks}
            for check in self._exercise.unsolved:
                if check not in helped:
                    yield f"{self._file}: the starting point fails {check}, but no [[hint]] lists this check."
        yield from lesson_problems(self._file.with_name("lesson.md"), self._app)
        yield from _notebook(self._root / "solutions" / self._name)
        yield from _judged(self._exercise, self._solution, _solution)
        yield from _judged(self._exercise, self._starting_point, _starting_point)

    def _graded(self, what: str, side: str) -> Report:
        self._tell(f"{self._name}: grading the {what}")
        folder = self._root / side / self._name
        opened = open_submission(folder) if self._exercise.package else open_answers(folder)
        return grade(self._exercise, opened, Options(in_cell=bubblewrap.usable())).report


def _judged(
    exercise: Exercise, grading: Future[Report], problems: Callable[[Exercise, Report], Iterator[str]]
) -> Iterator[str]:
    try:
        report = grading.result()
    except UsageError as error:  # the folder does not exist, or contains no package
        yield str(error)
    else:
        yield from problems(exercise, report)


def _solution(exercise: Exercise, report: Report) -> Iterator[str]:
    for outcome in report.outcomes:
        if outcome.status is not Status.PASSED and not outcome.advice:
            yield f"solutions/{exercise.id} does not pass: {_in_words(outcome)}"


def _starting_point(exercise: Exercise, report: Report) -> Iterator[str]:
    failed = {outcome.id: outcome for outcome in report.with_status(Status.FAILED)}
    for outcome in report.with_status(Status.ERROR):
        yield f"exercises/{exercise.id} could not be judged: {_in_words(outcome)}"
    if not exercise.unsolved and not report.with_status(Status.ERROR) and not failed:
        yield f"exercises/{exercise.id} fails no check. A starting point must fail at least one check."
        return
    if not exercise.unsolved and failed:
        yield (
            f"course/{exercise.id}/exercise.toml does not list the checks that the starting point fails. Add: "
            f"starting_point_fails = {list(failed)}"
        )
        return
    for name, outcome in failed.items():
        if name not in exercise.unsolved:
            yield f"exercises/{exercise.id} fails for an unintended reason: {_in_words(outcome)}"
    for name in exercise.unsolved:
        if name not in failed:
            yield f"exercises/{exercise.id} should fail the check {name!r} but does not."


def lesson_problems(file: Path, app: typer.Typer) -> Iterator[str]:
    """Yield the problems of a lesson: its length, its links and its commands. `app` is the command `grader`."""
    if not file.is_file():
        yield f"{file} is missing: every step has a lesson."
        return
    try:
        text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        line = line_at(error.object, error.start)
        yield f"{file}, line {line}: this is not UTF-8. Save the file as UTF-8."
        return
    words = len(_CODE.sub("", text).split())
    low, high = LESSON_WORDS
    if not low <= words <= high:
        yield f"{file} has {count(words, 'word')} (without code). A lesson should have {low} to {high}."
    for target in _LINK.findall(_CODE.sub("", text)):
        if (
            not target.startswith(("http://", "https://", "#"))
            and not (file.parent / target.partition("#")[0]).exists()
        ):
            yield f"{file} links to {target}, which does not exist."
    yield from (f"{file}: {problem}" for problem in command_problems(text, file.parent.parent, app, file.parent.name))


def _notebook(solution: Path) -> Iterator[str]:
    """Yield a sentence if the step has no notebook of its own. Without one, nbgrader cannot generate the assignment."""
    name = f"{solution.name}.ipynb"
    if solution.is_dir() and not (solution / name).is_file():
        yield (
            f"{solution}/{name} is missing: every step has a notebook. Copy the notebook of another step to this file, "
            "change the texts and the file names after %%node, and run: grader release"
        )


def _in_words(outcome: Outcome) -> str:
    finding = outcome.finding
    return f"{outcome.title}: {outcome.status.value}. {finding.observed} {finding.cause}".strip()

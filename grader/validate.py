"""Validate the course, for its authors: every exercise, its solution, its starting point, its lesson."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader import sandbox
from grader.errors import UsageError
from grader.exercise import catalogue, course_folder, load_exercise
from grader.grade import Options, grade
from grader.outcome import Status
from grader.release import stale
from grader.submission import open_answers, open_submission
from grader.words import a_list

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from grader.exercise import Exercise
    from grader.outcome import Outcome, Report

LESSON_WORDS = (1200, 2000)
_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
_CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)


def validate(names: list[str], tell: Callable[[str], None] = lambda _: None) -> list[str]:
    """The problems of these exercises (all of the course when empty), a sentence each, with what to do.

    `tell` hears what is being done: grading takes its time.
    """
    course = course_folder()
    files = catalogue(course)
    unknown = [name for name in names if name not in files]
    if unknown:
        message = f"There is no exercise {a_list(unknown, 'or')}. The exercises are {a_list(list(files))}."
        raise UsageError(message)
    problems = [
        f"{line} Run: grader release" for line in stale(course.parent / "solutions", course.parent / "exercises")
    ]
    for name in names or files:
        problems += _exercise(name, files[name], course.parent, tell)
    return problems


def _exercise(name: str, file: Path, root: Path, tell: Callable[[str], None]) -> Iterator[str]:
    try:
        exercise = load_exercise(file)
    except UsageError as error:
        yield str(error)
        return
    if not exercise.hints:
        yield f"{file}: there is no [[hint]]; a learner who is stuck needs some."
    yield from _lesson(file.with_name("lesson.md"))
    tell(f"{name}: grading the solution")
    yield from _solution(exercise, _graded(exercise, root / "solutions" / name))
    tell(f"{name}: grading the starting point")
    yield from _starting_point(exercise, _graded(exercise, root / "exercises" / name))


def _graded(exercise: Exercise, folder: Path) -> Report:
    opened = open_submission(folder) if exercise.package else open_answers(folder)
    return grade(exercise, opened, Options(in_cell=sandbox.usable())).report


def _solution(exercise: Exercise, report: Report) -> Iterator[str]:
    for outcome in report.outcomes:
        if outcome.status is not Status.PASSED and not outcome.advice:
            yield f"solutions/{exercise.id} does not pass: {_told(outcome)}"


def _starting_point(exercise: Exercise, report: Report) -> Iterator[str]:
    failed = {outcome.id: outcome for outcome in report.with_status(Status.FAILED)}
    for outcome in report.with_status(Status.ERROR):
        yield f"exercises/{exercise.id} could not be judged: {_told(outcome)}"
    if not exercise.unsolved:
        yield (
            f"course/{exercise.id}/exercise.toml does not say which checks the starting point fails. Now these do: "
            f"starting_point_fails = {list(failed)}"
        )
        return
    for name, outcome in failed.items():
        if name not in exercise.unsolved:
            yield f"exercises/{exercise.id} fails for a reason that was not intended: {_told(outcome)}"
    for name in exercise.unsolved:
        if name not in failed:
            yield f"exercises/{exercise.id} was to fail the check {name!r}, and does not."


def _lesson(file: Path) -> Iterator[str]:
    if not file.is_file():
        yield f"{file} is missing: every step has a lesson."
        return
    text = file.read_text(encoding="utf-8")
    words = len(_CODE.sub("", text).split())
    low, high = LESSON_WORDS
    if not low <= words <= high:
        yield f"{file} has {words} words (code left out); a lesson has {low} to {high}."
    for target in _LINK.findall(_CODE.sub("", text)):
        if (
            not target.startswith(("http://", "https://", "#"))
            and not (file.parent / target.partition("#")[0]).exists()
        ):
            yield f"{file} links to {target}, which is not there."


def _told(outcome: Outcome) -> str:
    finding = outcome.finding
    return f"{outcome.title}: {outcome.status.value}. {finding.seen} {finding.cause}".strip()

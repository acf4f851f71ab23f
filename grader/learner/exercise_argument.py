"""Determine the exercise and the folder from the arguments of `grader check`, `grader run` and `grader watch`."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from grader.checks.exercises import exercise_of_folder, find_exercise
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder
from grader.learner import progress, steps, workspace
from grader.submission.handed_in import open_handed_in
from grader.submission.package import open_submission

if TYPE_CHECKING:
    from grader.exercise.model import Exercise
    from grader.submission.package import Submission

NAME_IT = "Name the exercise with --exercise"


def meant(
    path: Path | None, exercise: str | None, folder: Path | None = None, *, advice: str = NAME_IT
) -> tuple[Exercise, Path]:
    """Return the exercise and the folder that contains the learner's work on the exercise.

    See `guessed` for the arguments. `advice` is the part of the message that says how to name the exercise.

    Raises:
        UsageError: the arguments do not determine the exercise, no exercise has that name, or the folder of the step
            does not exist.
        MachineError: the learner's progress cannot be read.
    """
    known, place = guessed(path, exercise, folder)
    if known is None and not place.exists():
        message = f"There is no folder {place}. Give the folder of your package, or a step such as 03."
        raise UsageError(message)
    if known is None:
        current = steps.current(folder)
        message = f"Which exercise is {place.resolve().name} for? {advice}, one of: {', '.join(catalogue())}. " + (
            f"Without a path, the command uses your current step, {current[0].id}, in {current[1]}."
            if current is not None
            else "Or start a step in your workspace: `grader start 01`."
        )
        raise UsageError(message)
    return known, place


def opened(path: Path | None, name: str | None) -> tuple[Exercise, Submission]:
    """Open the submission, and determine its exercise from the path, the name or, if necessary, the package.

    Raises:
        UsageError: the arguments do not determine the exercise, or the submission cannot be opened.
        MachineError: the learner's progress or the submission cannot be read because of the machine.
    """
    known, place = guessed(path, name)
    if known is not None and not known.package:
        return known, open_handed_in(place, known)
    package = open_package(place, known, typed=path is not None)
    return known or meant(package.package_dir, None)[0], package


def guessed(path: Path | None, exercise: str | None, folder: Path | None = None) -> tuple[Exercise | None, Path]:
    """Return the exercise (None if the arguments do not determine it) and the folder with the learner's work.

    `path` is the path that was typed: a package, a step ("03", "3") or the folder of its lesson, the workspace (for its
    current step), or None. `exercise` is the value of --exercise. `folder` is the workspace, or None for the learner's
    default workspace.

        guessed(Path("03"), None)  # step 03 and the package in the workspace

    Raises:
        UsageError: no exercise has that name, or the folder of the step does not exist.
        MachineError: the learner's progress cannot be read.
    """
    root = progress.workspace_of(folder)
    if path is not None and not path.exists() and _is_step(str(path)):
        return _step(str(path), root)
    lesson = path.resolve() if path is not None else None
    if lesson is not None and lesson.parent == course_folder() and lesson.name in catalogue():
        return _step(lesson.name, root)
    current = steps.current(folder)
    of_workspace = path is None or path.resolve() in (root, root / "src")
    known = find_exercise(exercise) if exercise else None
    if of_workspace and current is not None and (known is None or known.id == current[0].id):
        _check_there(*current)
        return current
    place = path or Path()
    known = known or exercise_of_folder(place)
    if known is None and current is not None and current[1].resolve() == place.resolve():
        known = current[0]
    return known, place


def _check_there(step: Exercise, place: Path) -> None:
    if not place.is_dir():
        start = f"grader start {step.id[:2]}"
        renamed = _renamed(place)
        cause = (
            f"If {renamed} is your package, type `{_rename_command(renamed, place)}`."
            if renamed is not None
            else "If you moved your workspace, type "
            f"`export ROS2_WORKSPACE=NEW_PATH` and `{start}`, which overwrites nothing."
        )
        message = (
            f"The folder of your step, {place}, no longer exists. {cause} To begin the step again, type `{start}`."
        )
        raise UsageError(message)


def _renamed(place: Path) -> Path | None:
    """Return the only folder beside the missing folder `place` that contains a package.xml, or None."""
    try:
        found = [each.parent for each in place.parent.glob("*/package.xml")]
    except OSError:
        return None
    return found[0] if len(found) == 1 else None


def _rename_command(old: Path, new: Path) -> str:
    return f"mv {quote(str(old))} {quote(str(new))}"


def open_package(place: Path, exercise: Exercise | None, *, typed: bool) -> Submission:
    """Open the package in a folder. `typed` is true if the user typed a path.

    If the exercise is known, the cells of a notebook also count, as in `open_handed_in`.

    Raises:
        UsageError: the folder does not contain exactly one package, or cannot be read. If no path was typed, the
            message also contains the command that starts the first step.
    """
    try:
        return open_submission(place) if exercise is None else open_handed_in(place, exercise)
    except UsageError as error:
        if typed:
            raise
        message = f"{error} If you have not started a step yet, type `grader start 01`."
        raise UsageError(message) from error


def _is_step(name: str) -> bool:
    """Return whether the name is the id of a step, or consists of digits."""
    return name.isdigit() or name in catalogue()


def _step(name: str, root: Path) -> tuple[Exercise, Path]:
    exercise = find_exercise(name)
    return exercise, existing_work(exercise, root)


def existing_work(exercise: Exercise, root: Path) -> Path:
    """Return the folder with the learner's work on the exercise in the workspace `root`.

    Raises:
        UsageError: the folder does not exist.
    """
    place = workspace.work_folder(exercise, root)
    if not place.is_dir():
        message = f"There is no folder {place}. `grader start {exercise.id[:2]}` creates it."
        renamed = _renamed(place)
        if renamed is not None:
            message += f" If your package is {renamed}, type `{_rename_command(renamed, place)}` instead."
        raise UsageError(message)
    return place

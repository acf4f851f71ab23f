"""The starting point of a step: the files in exercises/ with which a student begins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.errors import MachineError
from grader.exercise.model import course_folder

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.model import Exercise


def starting_point(exercise: Exercise) -> Path:
    """Return the folder in exercises/ with the starting point of the step.

    Raises:
        MachineError: the folder is missing.
    """
    folder = course_folder().parent / "exercises" / exercise.id
    if not folder.is_dir():
        message = f"The starting point of {exercise.id} is missing ({folder}). Install the course again."
        raise MachineError(message)
    return folder

"""Refuse to grade with code and checks that were loaded before an update of the course."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from grader.common.updated import START_AGAIN, updated
from grader.errors import MachineError
from grader.exercise.model import FILE_NAME

if TYPE_CHECKING:
    from grader.exercise.model import Exercise


def require_current(exercise: Exercise) -> None:
    """Raise MachineError if the grader or the exercise has changed since this process loaded them.

    Old code together with new code would give errors or wrong verdicts.
    """
    try:
        current = hashlib.sha256((exercise.folder / FILE_NAME).read_bytes()).hexdigest()
    except OSError:
        current = ""
    if current != exercise.digest or updated():
        raise MachineError(START_AGAIN)

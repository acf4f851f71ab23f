"""Let nbgrader's formgrader show a class in which the file with the time of a submission is invalid.

The formgrader reads `timestamp.txt` of every submission that is shown on a page. `nbgrader collect` rejects an invalid
file, but an instructor may also copy submissions to `submitted/`, for example from the archive of an LMS. Without this
module, one invalid file would make the page of the whole class fail.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.errors import GraderError
from grader.gradebook.readable import time_of

if TYPE_CHECKING:
    from datetime import datetime


def install() -> None:
    """Replace the function with which nbgrader's formgrader reads the time of a submission."""
    from nbgrader.apps.api import NbGraderAPI

    NbGraderAPI.get_submitted_timestamp = _submitted_timestamp


def _submitted_timestamp(self: Any, assignment_id: str, student_id: str) -> datetime | None:  # noqa: ANN401 - NbGraderAPI
    """Return the time of a submission, or None if the file is missing or invalid.

    `nbgrader autograde` and `grader gradebook sync` report an invalid file.
    """
    courses = self.coursedir
    try:
        return time_of(Path(courses.format_path(courses.submitted_directory, student_id, assignment_id)))
    except (GraderError, OSError):
        return None

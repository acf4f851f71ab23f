"""A submission that was found in the folders of a class, before it is read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from grader.classroom.refused import Refused

UNKNOWN = ""
"""The exercise id of a submission whose exercise cannot be determined from the names of the folders."""


@dataclass(frozen=True)
class Found:
    """A folder or an archive that a student handed in for an exercise."""

    student: str
    exercise: str
    path: Path
    """An absolute path in which all links have been resolved. If the path contains a link when the submission is read,
    a student has replaced a folder with this link, so the submission is not graded."""
    refused: Refused | None = None
    """The reason why the submission cannot be graded, if the reason is already known."""
    alike: str = ""
    """A message that lists the names with the same student id, or an empty string if there is only one name."""

    @property
    def name(self) -> str:
        """The name of the submission in reports and messages."""
        return self.student

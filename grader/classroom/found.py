"""A submission that was found in the folders of a class, before it is read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import a_list

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from grader.classroom.refused import Refused

_WORK = (".ipynb", ".py", ".toml")
"""The extensions of files that a student may have handed in without a folder. Some LMS put all such files together."""
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


def what_to_do_with(files: Iterable[str]) -> str:
    """Return what to do with those of the ignored files that may be a student's work, or "" if there is none."""
    work = [name for name in files if name.lower().endswith(_WORK)]
    each = "it" if len(work) == 1 else "each of them"
    return f" To grade {a_list(work)}, put {each} into a folder with the name of the student." if work else ""

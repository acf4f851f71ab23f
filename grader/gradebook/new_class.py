"""`grader class new DIR`: create a course folder in which nbgrader's commands work as its manual describes."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.authoring.release import release
from grader.classroom.roster import read_roster
from grader.common.new_folder import new_folder
from grader.common.words import shorten
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder
from grader.gradebook.class_folders import CLASS, ID, open_class
from grader.gradebook.config import COURSE_ID
from grader.submission.search import IGNORE_MARKER

if TYPE_CHECKING:
    from pathlib import Path

    from grader.gradebook.class_folders import ClassFolders

COLUMNS = ("id", "first_name", "last_name", "email")
_LEFTOVERS = shutil.ignore_patterns("__pycache__", "*.pyc", ".ipynb_checkpoints", "build", "install", "log")


@dataclass(frozen=True)
class NewClass:
    """A class that was created: the number of its students, and the course's name in nbgrader's exchange."""

    students: int
    course_id: str


def make_class(folder: Path, roster: Path | None) -> NewClass:
    """Create the folder and add the students of the roster to its gradebook.

    The course's name in nbgrader's exchange is derived from the name of the folder (`course_id`).

    Raises:
        UsageError: the folder is not empty, the roster is invalid, or this copy of the course has no solutions.
        MachineError: the folder cannot be written, or nbgrader is not installed.
    """
    students = read_students(roster) if roster else []
    root = course_folder().parent
    if not (root / "solutions").is_dir():
        message = "This copy of the course has no solutions. A class needs a complete checkout of the course."
        raise UsageError(message)
    with new_folder(folder, mode=0o700):  # other users must not read the solutions and the gradebook
        # Without this file, colcon in this folder would run the setup.py of every submission outside the sandbox.
        (folder / IGNORE_MARKER).touch()
        in_exchange = course_id(folder)
        (folder / CLASS).mkdir(mode=0o700)
        (folder / CLASS / ID).write_text(f"{in_exchange}\n", encoding="utf-8")
        shutil.copytree(root / "course", folder / "course", ignore=_LEFTOVERS)
        for name in catalogue():
            shutil.copytree(root / "solutions" / name, folder / "solutions" / name, ignore=_LEFTOVERS)
            release(folder / "solutions" / name, folder / "exercises" / name)
        _enrol(students, open_class(folder / "course"))
    return NewClass(len(students), in_exchange)


def course_id(folder: Path) -> str:
    """Return the course's name in nbgrader's exchange. The name is valid as a folder name and in commands."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", folder.resolve().name).strip(".-") or COURSE_ID


def _enrol(students: list[dict[str, str]], folders: ClassFolders) -> None:
    """Create the gradebook, and add the students to it."""
    with folders.gradebook() as gradebook:
        for student in students:
            about = {key: value for key, value in student.items() if key != "id" and value}
            gradebook.update_or_create_student(student["id"], **about)


def read_students(file: Path) -> list[dict[str, str]]:
    """Return the students of a roster as dictionaries by column name. Raises UsageError, as `read_roster` does."""
    rows = read_roster(file, COLUMNS[:1], COLUMNS[1:])
    for line, student in rows.items():
        # nbgrader uses ids as folder names, and puts + into names in the exchange.
        if "/" in student["id"] or student["id"].startswith(".") or "+" in student["id"]:
            why = 'nbgrader uses it as a folder name, so it must not contain "/" or "+" or begin with "."'
            message = f'{file}, line {line}: the id is "{shorten(student["id"])}"; {why}.'
            raise UsageError(message)
    return list(rows.values())

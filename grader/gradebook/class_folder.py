"""`grader class new DIR`: a course folder for an instructor, in which nbgrader's commands work as its manual says."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

from grader.authoring.release import release
from grader.classroom.roster import read_roster
from grader.common.words import shorten
from grader.errors import MachineError, UsageError
from grader.exercise.model import catalogue, course_folder
from grader.gradebook.folders import CONFIG, open_class
from grader.submission.search import IGNORE_MARKER

if TYPE_CHECKING:
    from pathlib import Path

COLUMNS = ("id", "first_name", "last_name", "email")
_LEFTOVERS = shutil.ignore_patterns("__pycache__", "*.pyc", ".ipynb_checkpoints", "build", "install", "log")


def make_class(folder: Path, roster: Path | None) -> int:
    """Make the folder, with the roster's students in its gradebook; returns how many there are.

    Raises:
        UsageError: the folder is not empty, the roster is none, or this copy of the course has no solutions.
        MachineError: it cannot be written, or nbgrader is not installed.
    """
    students = read_students(roster) if roster else []
    root = course_folder().parent
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        message = f"{folder} is not an empty folder: name a new one."
        raise UsageError(message)
    if not (root / "solutions").is_dir():
        message = "This copy of the course comes without solutions: a class is made from a whole checkout."
        raise UsageError(message)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        # colcon, called in this folder, would run the setup.py of every submission outside of the sandbox.
        (folder / IGNORE_MARKER).touch()
        shutil.copytree(root / "course", folder / "course", ignore=_LEFTOVERS)
        for name in catalogue():
            shutil.copytree(root / "solutions" / name, folder / "solutions" / name, ignore=_LEFTOVERS)
            release(folder / "solutions" / name, folder / "exercises" / name)
    except OSError as error:
        message = f"{error.filename or folder} could not be written: {error.strerror}."
        raise MachineError(message) from error
    assert (folder / "course" / CONFIG).is_file()
    folders = open_class(folder / "course")
    from nbgrader.api import Gradebook

    with Gradebook(folders.course.db_url, folders.course.course_id) as gradebook:
        for student in students:
            about = {key: value for key, value in student.items() if key != "id" and value}
            gradebook.update_or_create_student(student["id"], **about)
    return len(students)


def read_students(file: Path) -> list[dict[str, str]]:
    """The students of a roster, each with COLUMNS. Raises UsageError where the file is none."""
    rows = read_roster(file, COLUMNS[:1], COLUMNS[1:])
    for line, student in rows.items():
        # nbgrader makes folders of it, and names with a + in the exchange.
        if "/" in student["id"] or student["id"].startswith(".") or "+" in student["id"]:
            why = 'nbgrader makes a folder of it: no "/", no "+", and no "." at its beginning'
            message = f'{file}, line {line}: the id is "{shorten(student["id"])}"; {why}.'
            raise UsageError(message)
    return list(rows.values())

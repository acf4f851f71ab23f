"""Where the submissions of a class are: which student handed in what, for which exercise.

Three trees are known, and may be mixed: a folder or an archive a student; nbgrader's submitted/STUDENT/EXERCISE; a
folder of classroom clones, each with the course's exercises/EXERCISE in it.
"""

from __future__ import annotations

import stat
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.classroom import archives
from grader.common.words import a_list
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.submission.search import PACKAGE_FILES
from grader.submission.tree import shown, sort_key

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

OWN = "exercises"
"""The folder of a clone that holds what the student works on."""


@dataclass(frozen=True)
class Found:
    """What a student handed in for an exercise: a folder, or an archive."""

    student: str
    exercise: str
    path: Path
    refused: str = ""
    """Why it cannot be graded, where whoever found it could not read it."""

    @property
    def name(self) -> str:
        """As reports and messages call it."""
        return self.student


def find_submissions(given: Sequence[Path], exercise: str | None, leave_out: Path) -> tuple[Found, ...]:
    """All submissions in the folders, archives and packages `given`, by student; `leave_out` is passed over.

    Raises:
        UsageError: there is none, two are of the same student, or nothing says which exercise it is.
    """
    wanted = find_exercise(exercise).id if exercise else None
    found = [each for path in given for each in _in(path, wanted, leave_out.resolve())]
    if not found:
        message = (
            f"There is no submission in {a_list([shown(str(path)) for path in given])}: give the folder that holds a "
            "folder or an archive (.zip, .tar.gz) of each student."
        )
        raise UsageError(message)
    seen: dict[tuple[str, str], Found] = {}
    for each in found:
        other = seen.setdefault((each.student, each.exercise), each)
        if other is not each:
            message = (
                f"{shown(each.student)} is there twice: {shown(str(other.path))} and {shown(str(each.path))}. Take one "
                "of them away, or rename it."
            )
            raise UsageError(message)
    return tuple(sorted(found, key=lambda each: (sort_key(each.student), each.exercise)))


def passed_over(given: Sequence[Path], leave_out: Path) -> tuple[str, ...]:
    """The names of what lies beside submissions and is none: files, links. What is hidden is not named."""
    folders = [path for path in given if path.is_dir() and not _is_one(path)]
    return tuple(
        shown(entry.name)
        for folder in folders
        for entry in sorted(folder.iterdir(), key=lambda each: sort_key(each.name))
        if not entry.name.startswith((".", "__MACOSX"))
        and _student(entry) is None
        and entry.resolve() != leave_out.resolve()
    )


def _in(path: Path, wanted: str | None, leave_out: Path) -> Iterator[Found]:
    if not path.exists():
        message = f"There is no {shown(str(path))}. Give the folder that holds a folder or an archive of each student."
        raise UsageError(message)
    absolute = path.resolve()
    if not path.is_dir() or _is_one(path):
        name = archives.stem(absolute.name) if not path.is_dir() else absolute.name
        if name is None:
            message = f"{shown(str(path))} is neither a folder nor an archive (.zip, .tar.gz)."
            raise UsageError(message)
        yield from _of_student(name, path, wanted)
        return
    for entry in sorted(path.iterdir(), key=lambda each: sort_key(each.name)):
        name = _student(entry)
        if name is not None and entry.resolve() != leave_out:
            yield from _of_student(name, entry, wanted)


def _is_one(folder: Path) -> bool:
    """Whether a folder is one submission by itself: a package, or a clone of the course."""
    return any((folder / name).exists() for name in (*PACKAGE_FILES, OWN))


def _student(entry: Path) -> str | None:
    """Whose it is; None for what lies about beside submissions: hidden files, lists, notes."""
    if entry.name.startswith(".") or entry.name == "__MACOSX":
        return None
    mode = entry.lstat().st_mode
    if stat.S_ISDIR(mode):
        return entry.name
    return archives.stem(entry.name) if stat.S_ISREG(mode) else None


def _of_student(student: str, path: Path, wanted: str | None) -> Iterator[Found]:
    assigned = _assignments(path)
    if assigned:
        yield from (Found(student, name, path / name) for name in assigned if wanted in (None, name))
        return
    if wanted is None:
        message = (
            f"Which exercise is {shown(str(path))} for? Say it with --exercise, one of: {', '.join(catalogue())}. "
            "(In nbgrader's tree, submitted/STUDENT/EXERCISE, it follows from the folder.)"
        )
        raise UsageError(message)
    own = path / OWN / wanted
    if path.is_dir() and own.is_dir() and not _leads_away((path / OWN, own)):
        yield Found(student, wanted, own)
    else:
        yield Found(student, wanted, path)


def _assignments(path: Path) -> list[str]:
    """The exercises in a student's folder, as nbgrader lays them out."""
    if not path.is_dir() or _is_one(path):
        return []
    return [name for name in catalogue() if (path / name).is_dir() and not (path / name).is_symlink()]


def _leads_away(folders: Iterable[Path]) -> bool:
    return any(folder.is_symlink() for folder in folders)

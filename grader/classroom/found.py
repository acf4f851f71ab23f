"""Where the submissions of a class are: which student handed in what, for which exercise.

Three trees are known, and may be mixed: a folder or an archive a student; nbgrader's submitted/STUDENT/EXERCISE; a
folder of classroom clones, each with the course's exercises/EXERCISE in it.

Nobody vanishes: each folder and archive becomes a submission, if only with the reason why it is not graded. Functions
of os.path say of a place that cannot be looked at that nothing is there; those of pathlib raise.
"""

# ruff: noqa: PTH110, PTH112, PTH114

from __future__ import annotations

import os
import stat
from dataclasses import dataclass, replace
from pathlib import Path
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

UNKNOWN = ""
"""The exercise of a folder that does not tell it."""
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
        UsageError: there is none, or nothing says which exercise it is.
    """
    wanted = find_exercise(exercise).id if exercise else None
    found = [each for path in given for each in _in(path, wanted, leave_out)]
    if not found:
        message = (
            f"There is no submission in {a_list([shown(str(path)) for path in given])}: give the folder that holds a "
            "folder or an archive (.zip, .tar.gz) of each student."
        )
        raise UsageError(message)
    alike: dict[tuple[str, str], list[Found]] = {}
    for each in _of_known_exercises(found):
        alike.setdefault((each.student, each.exercise), []).append(each)
    submissions = (_one_of(each) for each in alike.values())
    return tuple(sorted(submissions, key=lambda each: (sort_key(each.student), each.exercise)))


def _of_known_exercises(found: Sequence[Found]) -> Iterator[Found]:
    """The same; a folder of which nobody knows the exercise counts for each that others were found for.

    Raises:
        UsageError: no exercise is known.
    """
    known = sorted({each.exercise for each in found} - {UNKNOWN})
    for each in found:
        if each.exercise != UNKNOWN:
            yield each
            continue
        if not known:
            message = (
                f"Which exercise is {shown(str(each.path))} for? Say it with --exercise, one of: "
                f"{', '.join(catalogue())}. (In nbgrader's tree, submitted/STUDENT/EXERCISE, it follows from the "
                "folder.)"
            )
            raise UsageError(message)
        for exercise in known:
            yield replace(each, exercise=exercise, refused=f"{shown(each.student)} holds no folder {exercise}.")


def _one_of(alike: Sequence[Found]) -> Found:
    """The submission of a student for an exercise; where there are several, none of them is graded."""
    if len(alike) == 1:
        return alike[0]
    paths = a_list([shown(str(each.path)) for each in alike])
    times = "twice" if len(alike) == 2 else f"{len(alike)} times"
    name = shown(alike[0].student)
    return replace(alike[0], refused=f"{name} is there {times}: {paths}. Take all but one away, or rename them.")


def passed_over(given: Sequence[Path], leave_out: Path) -> tuple[str, ...]:
    """The names of what lies beside submissions and is none: files, links. What is hidden is not named."""
    folders = [path for path in given if os.path.isdir(path) and not _is_one(path)]
    return tuple(
        shown(entry.name)
        for folder in folders
        for entry in _entries(folder)
        if not entry.name.startswith((".", "__MACOSX")) and _student(entry) is None and not _same(entry, leave_out)
    )


def _entries(folder: Path) -> list[Path]:
    """What the folder holds, in order. Raises UsageError where it cannot be opened."""
    try:
        return sorted(folder.iterdir(), key=lambda each: sort_key(each.name))
    except OSError as error:
        message = f"{shown(str(folder))} cannot be opened: {error.strerror}."
        raise UsageError(message) from error


def _same(one: Path, other: Path) -> bool:
    """Whether both lead to one place; links that lead in a circle lead nowhere."""
    return os.path.realpath(one) == os.path.realpath(other)


def _in(path: Path, wanted: str | None, leave_out: Path) -> Iterator[Found]:
    if not os.path.exists(path):
        message = f"There is no {shown(str(path))}. Give the folder that holds a folder or an archive of each student."
        raise UsageError(message)
    absolute = Path(os.path.realpath(path))
    if not os.path.isdir(path) or _is_one(path):
        name = absolute.name if os.path.isdir(path) else archives.stem(absolute.name)
        if name is None:
            message = f"{shown(str(path))} is neither a folder nor an archive (.zip, .tar.gz)."
            raise UsageError(message)
        yield from _of_student(name, path, wanted)
        return
    for entry in _entries(path):
        name = _student(entry)
        if name is not None and not _same(entry, leave_out):
            yield from _of_student(name, entry, wanted)


def _is_one(folder: Path) -> bool:
    """Whether a folder is one submission by itself: a package, or a clone of the course."""
    return any(os.path.exists(folder / name) for name in (*PACKAGE_FILES, OWN))


def _student(entry: Path) -> str | None:
    """Whose it is; None for what lies about beside submissions: hidden files, lists, notes."""
    if entry.name.startswith(".") or entry.name == "__MACOSX":
        return None
    try:
        mode = entry.lstat().st_mode
    except OSError:
        return entry.name  # Nobody may look at it: whoever reads it says so.
    if stat.S_ISDIR(mode):
        return entry.name
    return archives.stem(entry.name) if stat.S_ISREG(mode) else None


def _of_student(student: str, path: Path, wanted: str | None) -> Iterator[Found]:
    assigned = _assignments(path)
    own = path / OWN / (wanted or UNKNOWN)
    if assigned and wanted not in (None, *assigned):
        refused = f"{shown(student)} holds {a_list(assigned)}, and no folder {wanted}."
        yield Found(student, wanted or UNKNOWN, path, refused)
    elif assigned:
        yield from (Found(student, name, path / name) for name in assigned if wanted in (None, name))
    elif wanted and os.path.isdir(own) and not _leads_away((path / OWN, own)):
        yield Found(student, wanted, own)
    else:
        yield Found(student, wanted or UNKNOWN, path)


def _assignments(path: Path) -> list[str]:
    """The exercises in a student's folder, as nbgrader lays them out."""
    if not os.path.isdir(path) or _is_one(path):
        return []
    return [name for name in catalogue() if os.path.isdir(path / name) and not os.path.islink(path / name)]


def _leads_away(folders: Iterable[Path]) -> bool:
    return any(os.path.islink(folder) for folder in folders)

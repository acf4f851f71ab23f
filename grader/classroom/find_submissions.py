"""Find the submissions of a class with their students and exercises.

Three layouts are supported and can be mixed: one folder or archive per student; nbgrader's submitted/STUDENT/EXERCISE;
and a folder with students' clones of the course, each of which contains exercises/EXERCISE.

Each folder, archive and symbolic link becomes a submission, except what programs create (such as .git). Links are
included because a student may have replaced a folder with a link. If a submission cannot be graded, `Found.refused`
contains the reason. This module uses os.path, because the functions of os.path return False for a path that cannot be
accessed. Before Python 3.14, the methods of pathlib raise an exception.
"""

# ruff: noqa: PTH110, PTH112, PTH113, PTH114

from __future__ import annotations

import os
import re
import stat
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.classroom import archives
from grader.classroom.duplicates import without_duplicates
from grader.classroom.found import UNKNOWN, Found, what_to_do_with
from grader.classroom.own_folders import has_results, is_same
from grader.classroom.refused import Refused
from grader.common.words import a_list
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.submission.search import PACKAGE_FILES
from grader.submission.tree import LEFT_OUT, MAX_ENTRIES, shown, sort_key

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

OWN = "exercises"
"""The folder of a clone of the course that contains the student's work."""
_OF_PROGRAMS = (".git", ".github", ".gitlab", ".idea", ".ipynb_checkpoints", ".venv", ".vscode", "__MACOSX")
"""Folders that programs create next to submissions."""
_OF_THE_COURSE = (OWN, "course", "docs", "grader", "solutions")
"""The folders of a clone of the course."""


def find_submissions(given: Sequence[Path], exercise: str | None, leave_out: Path) -> tuple[Found, ...]:
    """Return all submissions in the given folders, archives and packages except `leave_out`, sorted by student.

    Raises:
        UsageError: a path cannot be used, no submission was found, or the exercise cannot be determined.
    """
    wanted = find_exercise(exercise).id if exercise else None
    found = [each for path in given for each in _in(path, wanted, leave_out)]
    if not found:
        message = (
            f"No submission was found in {a_list([shown(str(path)) for path in given])}. Give the folder with one "
            f"folder or archive (.zip, .tar.gz) per student.{what_to_do_with(passed_over(given, leave_out))}"
        )
        raise UsageError(message)
    _require_class(given, found, wanted)
    submissions = without_duplicates(_of_known_exercises(found))
    return tuple(sorted(submissions, key=lambda each: (sort_key(each.student), each.exercise)))


def _require_class(given: Sequence[Path], found: Sequence[Found], wanted: str | None) -> None:
    """Raise UsageError if several of the given folders are those of students, as in `grader grade submitted/*`.

    A student's folder contains only folders with the names of the package or of exercises. If these were the names of
    students, several students would have the same name, and none of their submissions would be graded.
    """
    names = {*catalogue(), find_exercise(wanted).package if wanted else UNKNOWN}
    inside = [[each.path for each in found if each.path.parent == Path(os.path.realpath(path))] for path in given]
    ours = [each[0] for each in inside if each and all(path.name in names and os.path.isdir(path) for path in each)]
    if len(set(ours)) > 1:
        folders = a_list([shown(f"{each.parent.name}/{each.name}") for each in ours], most=3)
        parents = sorted({str(each.parent.parent) for each in ours})
        message = (
            f"{folders} have the name of the package or of an exercise, and not of a student. Give the folder that "
            f"contains the folders of the students: {shown(parents[0])}"
        )
        raise UsageError(message)


def _of_known_exercises(found: Sequence[Found]) -> Iterator[Found]:
    """Yield each submission with its exercise.

    If the exercise of a submission is unknown, yield the submission once for each exercise of the other submissions.

    Raises:
        UsageError: the exercise cannot be determined.
    """
    known = sorted({each.exercise for each in found} - {UNKNOWN})
    for each in found:
        if each.exercise != UNKNOWN:
            yield each
            continue
        if not known:
            message = (
                f"Which exercise is {shown(str(each.path))} for? Name the exercise with --exercise, one of: "
                f"{', '.join(catalogue())}. (In nbgrader's submitted/STUDENT/EXERCISE, the last folder has the name of "
                "the exercise.)"
            )
            raise UsageError(message)
        for exercise in known:
            missing = Refused(f"{shown(each.student)} does not contain a folder {exercise}.", "exercise-missing")
            yield replace(each, exercise=exercise, refused=each.refused or missing)


def passed_over(given: Sequence[Path], leave_out: Path) -> tuple[str, ...]:
    """Return the names of entries in `given` that are not submissions, except hidden files and `leave_out`."""
    folders = [path for path in given if os.path.isdir(path) and not _is_one_alone(path)]
    return tuple(
        shown(entry.name)
        for folder in folders
        for entry in _entries(folder)
        if _student(entry) is None
        and not _why_not_graded(entry)
        and not (entry.name.startswith(".") and os.path.isfile(entry))
        and not _is_of_grader(entry, leave_out)
    )


def _entries(folder: Path) -> list[Path]:
    """Return the entries in the folder, sorted by name. Raises UsageError if the folder cannot be opened."""
    try:
        return sorted(folder.iterdir(), key=lambda each: sort_key(each.name))
    except OSError as error:
        message = f"{shown(str(folder))} cannot be opened: {error.strerror}."
        raise UsageError(message) from error


def _is_of_grader(entry: Path, leave_out: Path) -> bool:
    """Return whether the entry is a folder of results, of this run or of an earlier one."""
    return is_same(entry, leave_out) or (not os.path.islink(entry) and has_results(entry))


def _in(path: Path, wanted: str | None, leave_out: Path) -> Iterator[Found]:
    if not os.path.exists(path):
        message = f"{shown(str(path))} does not exist. Give the folder with one folder or archive per student."
        raise UsageError(message)
    absolute = Path(os.path.realpath(path))
    if has_results(absolute):
        message = (
            f"{shown(str(path))} contains results of `grader grade`, and not submissions. Give the folder with one "
            "folder or archive per student."
        )
        raise UsageError(message)
    if not os.path.isdir(path) or _is_one_alone(path):
        name = absolute.name if os.path.isdir(path) else archives.stem(absolute.name)
        if name is None:
            message = f"{shown(str(path))} is neither a folder nor an archive (.zip, .tar.gz)."
            raise UsageError(message)
        if Path(os.path.realpath(leave_out)).is_relative_to(absolute):
            message = (
                f"The results must not be inside {shown(str(path))}: the student may have put forged results there. "
                "Choose another folder with --out."
            )
            raise UsageError(message)
        yield from _of_student(name, absolute, wanted)
        return
    for entry in _entries(absolute):
        if _is_of_grader(entry, leave_out):
            continue
        name = _student(entry)
        if name is not None:
            yield from _of_student(name, entry, wanted)
        elif refused := _why_not_graded(entry):
            yield Found(archives.stem(entry.name) or entry.name, wanted or UNKNOWN, entry, refused)


def _is_one(folder: Path) -> bool:
    """Return whether the folder itself is a submission: a package, or a clone of the course."""
    return any(os.path.exists(folder / name) for name in (*PACKAGE_FILES, OWN))


def _is_one_alone(folder: Path) -> bool:
    """Return whether a folder that was given to the command is itself a submission, and not a class.

    In a class, a student's folder can have any name, such as "setup.py" or "exercises", and a file of a package can be
    beside the submissions. A package that lacks one of its files can contain a copy of itself.
    """
    present = [name for name in PACKAGE_FILES if os.path.isfile(folder / name)]
    if present:
        folders = [each for each in _entries(folder) if os.path.isdir(each) and each.name not in LEFT_OUT]
        inside = [each for each in folders if _is_handed_in(each)]
        return len(inside) < len(present)
    if not os.path.isdir(folder / OWN):
        return False
    others = [each for each in _entries(folder) if each.name not in _OF_THE_COURSE and _student(each) is not None]
    # A class can be in a git repository, too, and a student can choose the name of the folder `exercises`.
    return not others or (os.path.exists(folder / ".git") and not any(map(_is_handed_in, others)))


def _is_handed_in(entry: Path) -> bool:
    """Return whether an entry next to `exercises` is an archive, a submission, or a folder that contains a package."""
    return not os.path.isdir(entry) or _is_one(entry) or any(any(entry.glob(f"*/{name}")) for name in PACKAGE_FILES)


def _student(entry: Path) -> str | None:
    """Return the name of the student to whom an entry belongs, or None for other entries, such as links and rosters."""
    if entry.name.startswith(".") or entry.name == "__MACOSX":
        return None
    try:
        mode = entry.lstat().st_mode
    except OSError:
        return entry.name  # the error is reported when the entry is read
    if stat.S_ISDIR(mode):
        return entry.name
    return archives.stem(entry.name) if stat.S_ISREG(mode) else None


def _why_not_graded(entry: Path) -> Refused | None:
    """Return the reason why a link, a hidden folder or a hidden archive is not graded, or None for any other entry.

    The result is also None for what programs create.
    """
    # macOS stores the properties of a file x in a file ._x, for example on a USB stick.
    of_macos = entry.name.startswith("._") and os.path.isfile(entry) and os.path.isfile(entry.with_name(entry.name[2:]))
    if entry.name in _OF_PROGRAMS or (of_macos and not os.path.islink(entry)):
        return None
    if os.path.islink(entry):
        link = f"{shown(entry.name)} is a symbolic link. The grader does not follow links to submissions."
        return Refused(link, "submission-link")
    is_archive = os.path.isfile(entry) and entry.name.lower().endswith(archives.EVERY_ENDING)
    if entry.name.startswith(".") and (os.path.isdir(entry) or is_archive):
        hidden = f"{shown(entry.name)} is hidden, because its name begins with a dot. Rename it."
        return Refused(hidden, "submission-name")
    return None


def _of_student(student: str, path: Path, wanted: str | None) -> Iterator[Found]:
    assigned = _assignments(path)
    own = path / OWN / (wanted or UNKNOWN)
    if assigned and wanted not in (None, *assigned):
        reason = f"{shown(student)} contains {a_list(assigned)}, but no folder {wanted}."
        yield Found(student, wanted or UNKNOWN, path, Refused(reason, "exercise-missing"))
    elif assigned:
        yield from (Found(student, name, path / name) for name in assigned if wanted in (None, name))
        yield from (each for each in misnamed(student, path) if wanted in (None, each.exercise))
    elif wanted and os.path.isdir(own) and not any(map(os.path.islink, (path / OWN, own))):
        yield Found(student, wanted, own)
    else:
        yield Found(student, wanted or UNKNOWN, path)


def _assignments(path: Path) -> list[str]:
    """Return the exercises in a student's folder if it has nbgrader's layout, or an empty list."""
    if not os.path.isdir(path) or _is_one(path):
        return []
    return [name for name in catalogue() if os.path.isdir(path / name) and not os.path.islink(path / name)]


def misnamed(student: str, path: Path) -> Iterator[Found]:
    """Yield the entries of a student's folder that resemble the folder of an exercise, for example by their names.

    These entries are not graded. Examples are a folder with capital letters in its name, an archive, and a symbolic
    link. An entry is not yielded if the folder of its exercise also exists. Of a folder with too many entries to be a
    submission, no entry is yielded: the other students would have to wait.
    """
    present, known = _assignments(path), tuple(catalogue())
    try:
        entries = sorted(islice(path.iterdir(), MAX_ENTRIES + 1), key=lambda each: sort_key(each.name))
    except OSError:
        return  # the error is reported when the folder is read
    for entry in entries if len(entries) <= MAX_ENTRIES else ():
        name = re.sub(r"[^a-z0-9]+", "-", entry.name.lower())
        exercise = next((each for each in known if name.startswith(each)), None)
        if exercise is not None and exercise not in present:
            where = f"{shown(student)}/{shown(entry.name)}"
            todo = "Replace the symbolic link with the folder." if os.path.islink(entry) else "Rename or unpack it."
            reason = f"{where} must be a folder with the name {exercise}. {todo}"
            yield Found(student, exercise, entry, Refused(reason, "submission-name"))


def left_out(folder: Path, other_assignments: Collection[str]) -> tuple[Found, ...]:
    """Return what nbgrader does not see in submitted/: entries that are not in a folder STUDENT/EXERCISE.

    Each entry has the reason why it is not graded. A student's folder without an exercise is not returned if it
    contains one of the other assignments.
    """
    found: list[Found] = []
    for each in _in(folder, None, folder) if os.path.isdir(folder) and not _is_one_alone(folder) else ():
        if each.refused:
            found.append(each)
        elif each.exercise == UNKNOWN and not os.path.isdir(each.path):
            reason = f"{shown(each.path.name)} must be unpacked to a folder {shown(each.student)}/EXERCISE."
            found.append(replace(each, refused=Refused(reason, "submission-name")))
        elif each.exercise == UNKNOWN:
            almost = list(misnamed(each.student, each.path))
            others = any(os.path.isdir(each.path / name) for name in other_assignments)
            reason = f"{shown(each.student)} does not contain a folder with the name of an exercise."
            missing = replace(each, refused=Refused(reason, "exercise-missing"))
            found += almost or ([] if others else [missing])
    return tuple(found)

"""Read the package of a submission from a folder or an archive, or return the reason why it cannot be read."""

from __future__ import annotations

import hashlib
import re
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

from grader.classroom import archives, unpack
from grader.classroom.refused import Refused
from grader.errors import DiskError, MachineError, TooLargeError, UsageError
from grader.submission import reader
from grader.submission.handed_in import open_handed_in
from grader.submission.package import ANSWERS, Submission
from grader.submission.search import NoPackageError, SeveralPackagesError
from grader.submission.tree import shown

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from pathlib import Path

    from grader.checks.diagnosis import Diagnosis
    from grader.classroom.found import Found
    from grader.classroom.task import Task
    from grader.exercise.model import Exercise

_GIVE = re.compile(r"\b([Gg])ive (?=th)")
MOST_DEEP = 4
"""answers.toml may be inside up to this many nested folders, if each of them contains nothing but the next one. Entries
whose names begin with a dot or with `__`, such as `__MACOSX`, do not count."""


@dataclass(frozen=True)
class Content:
    """The submission to grade, or why it cannot be graded. `archive` is the sha256 of the archive that was read."""

    handed_in: Submission | Refused
    archive: str = ""


def read(found: Found, exercise: Exercise, student: str) -> Submission | Refused:
    """Return the submission to grade, or why it cannot be graded. `student` is the id of the student.

    Raises:
        DiskError: the disk for temporary files failed.
    """
    return content_of(found, exercise, student).handed_in


def content_of(found: Found, exercise: Exercise, student: str) -> Content:
    """Return what `read` returns, together with the hash of the archive if it was read from an archive.

    Raises:
        DiskError: the disk for temporary files failed.
    """
    if found.refused:
        return Content(found.refused)
    archive = _archive(found.path)
    if archive is None:
        return Content(_handed_in(found, exercise, student, nullcontext(found.path)))
    with archives.copied(archive) as copy:
        return Content(_handed_in(found, exercise, student, copy.unpacked(), inside=archive), copy.sha256)


def _handed_in(
    found: Found,
    exercise: Exercise,
    student: str,
    place: AbstractContextManager[Path],
    inside: Path | None = None,
) -> Submission | Refused:
    """Read the submission in the folder that `place` yields, or return the reason why it cannot be read.

    `inside` is the archive from which this folder is unpacked: the path of the submission, or a file in it.
    """
    named = shown(str((inside or found.path).relative_to(found.path.parent)))
    try:
        with place as folder:
            try:
                opened = reader.read(_open, folder, exercise)
            except UsageError as error:
                # Students read this, so it must not contain a path of this machine.
                reason = _GIVE.sub(_hand_in, str(error)).replace(shown(str(folder)), shown(found.name))
                return Refused(reason, _diagnosis(error, exercise))
    except unpack.NotUnpackedError as error:
        return Refused(f"{named} {error}.", error.diagnosis)
    except DiskError:
        raise
    except MachineError as error:
        return Refused(str(error), None)
    except (OSError, ValueError) as error:
        detail = error.strerror if isinstance(error, OSError) else str(error)
        return Refused(f"{named} could not be read ({detail}).", "unreadable")
    return replace(opened, name=found.name, student=student)


def _hand_in(give: re.Match[str]) -> str:
    """Replace a request to give a path to the command: a student hands in a folder."""
    return ("Hand" if give[1] == "G" else "hand") + " in "


def _diagnosis(error: UsageError, exercise: Exercise) -> Diagnosis:
    if isinstance(error, NoPackageError):
        return "no-package" if exercise.package else "no-answers-file"
    if isinstance(error, SeveralPackagesError):
        return "several-packages"
    return "submission-too-large" if isinstance(error, TooLargeError) else "unreadable"


def fingerprint(found: Found, exercise: Exercise, task: Task | None = None) -> str:
    """Return the sha256 of all relevant files of a submission, or of the reason why they cannot be read.

    With a `task`, the hash is that of the files or the archive from which the task was made, because the student may
    have changed the submission since then. Without a task, an archive is hashed without unpacking it.

    Raises:
        DiskError: the disk for temporary files failed.
    """
    also = (found.alike,) if found.alike else ()
    if task is not None:
        return _sha256(*_parts_of_task(task), *also)
    archive = None if found.refused else _archive(found.path)
    if archive is not None:
        return _sha256(archives.sha256_of(archive), *also)
    content = read(found, exercise, "")
    if isinstance(content, Refused):
        return _sha256(f"refused {content.reason}", *also)
    parts = (content.digest, content.package_dir.name, content.remark, *content.rejected, *sorted(content.executable))
    return _sha256(*parts, *also)


def _parts_of_task(task: Task) -> tuple[str, ...]:
    """Return the strings that `fingerprint` hashes for a task."""
    if task.archive:
        return (task.archive,)
    if isinstance(task.content, Refused):
        return (f"refused {task.content.reason}",)
    return (task.digest, task.package, task.remark, *task.rejected, *sorted(task.executable))


def _sha256(*parts: str) -> str:
    return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogateescape")).hexdigest()


def _archive(path: Path) -> Path | None:
    """Return the archive of a submission, or None.

    The archive is the path itself if it is a file, or the only entry of the folder, as in Moodle. Hidden entries do not
    count.
    """
    try:
        if not path.is_dir():
            return path
        inside = list(islice((entry for entry in path.iterdir() if not entry.name.startswith(".")), 2))
        if len(inside) != 1 or inside[0].is_symlink() or not inside[0].is_file():
            return None
    except OSError:
        return None  # reading the folder will report the reason
    return inside[0] if archives.stem(inside[0].name) else None


def _open(folder: Path, exercise: Exercise) -> Submission:
    if exercise.package:
        return open_handed_in(folder, exercise, exactly=True)
    for _ in range(MOST_DEEP):
        below = list(islice((entry for entry in folder.iterdir() if not entry.name.startswith((".", "__"))), 2))
        if len(below) != 1 or below[0].is_symlink() or not below[0].is_dir() or (folder / ANSWERS).exists():
            break
        folder = below[0]
    return open_handed_in(folder, exercise, exactly=True)

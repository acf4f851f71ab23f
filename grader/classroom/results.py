"""The results of a class on disk: one JSON file and one page per submission.

    OUT/reports/STUDENT.EXERCISE.json   the report (grader.report.json) with the additional keys student, key (key.py)
                                        and errors (how many times in a row grading ended with an error); it is for
                                        the instructor, because it contains hidden checks
    OUT/reports/STUDENT.EXERCISE.html   the page of the submission, without the details of hidden checks

Each file is written completely or not at all. The JSON is written after the page, so every result with a JSON file is
complete. A killed run may leave files whose names end in .partial, which the next run removes. Only one run at a time
may use a folder.
"""

from __future__ import annotations

import errno
import fcntl
import json
import os
import re
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.classroom.own_folders import MARK, has_results, is_among, is_same, mark
from grader.common.whole_file import PARTIAL, write_whole
from grader.errors import DiskError, MachineError, UsageError
from grader.report.json import from_json, to_data
from grader.report.suspicion import ERRORS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from grader.classroom.key import Key
    from grader.report.report import Report

REPORTS = "reports"
_SAFE = re.compile(r"[^A-Za-z0-9 _@+,=-]")
_LONGEST = 120
"""The maximum length of the student's part of a file name (bytes). A longer part is truncated, and gets a digest."""


@dataclass(frozen=True)
class Result:
    """A graded submission. `page` is the name of the submission's page in reports/."""

    student: str
    report: Report
    key: Mapping[str, Any]
    page: str
    errors: int = 0
    """How many times in a row grading the submission has ended with an `error`, including this time."""


def file_name(student: str, exercise: str, *, ignores_case: bool = False) -> str:
    """Return the file name of a result without its extension.

    The name is different for every student and valid on every file system. With `ignores_case`, two file names never
    differ only in capital letters.
    """
    # Characters are replaced with numbers, so that different names stay different. A dot would look like an extension.
    safe = _SAFE.sub(lambda match: "".join(f"%{byte:02X}" for byte in os.fsencode(match.group())), student)
    if len(safe) > _LONGEST or (ignores_case and student != student.lower()):
        import hashlib

        safe = f"{safe[: _LONGEST - 20]}%%{hashlib.sha256(os.fsencode(student)).hexdigest()[:16]}"
    return f"{safe}.{exercise}"


@dataclass(frozen=True)
class Results:
    """The folder of the results. Use `opened` to write results, so that no other run writes to the folder."""

    folder: Path

    @property
    def ignores_case(self) -> bool:
        """Whether `Anna` and `anna` are one file in this folder, as on the file systems of Windows."""
        return (self.folder / MARK.upper()).exists()

    def load(self, student: str, exercise: str) -> Result | None:
        """Return the complete result of a submission, whatever its key is, or None if there is no complete result."""
        name = file_name(student, exercise, ignores_case=self.ignores_case)
        file = self.folder / REPORTS / f"{name}.json"
        try:
            text = file.read_text(encoding="utf-8")
            data = json.loads(text)
            if data["student"] != _encodable(student) or not file.with_suffix(".html").is_file():
                return None
            return Result(student, from_json(text), data["key"], f"{name}.html", int(data.get(ERRORS, 0)))
        except (OSError, ValueError, KeyError, TypeError, UsageError):
            return None  # damaged, or written by another version of the grader

    def save(self, student: str, report: Report, key: Key, page: bytes, errors: int = 0) -> Result:
        """Write a result. Raises MachineError if the disk is full or not writable."""
        name = file_name(student, report.exercise, ignores_case=self.ignores_case)
        data = {**to_data(report), "student": _encodable(student), "key": key.to_data(), ERRORS: errors}
        self.write(f"{REPORTS}/{name}.html", page)
        text = json.dumps(data, ensure_ascii=False, indent=1) + "\n"
        self.write(f"{REPORTS}/{name}.json", text.encode("utf-8", "backslashreplace"))
        return Result(student, report, key.to_data(), f"{name}.html", errors)

    def write(self, name: str, content: bytes) -> Path:
        """Write a file in the folder, completely or not at all. Raises MachineError if the file cannot be written."""
        file = self.folder / name
        try:
            file.parent.mkdir(exist_ok=True)
            write_whole(file, content)
        except OSError as error:
            message = (
                f"{file} could not be written: {error.strerror}. The results so far are kept. If the disk is "
                "full, free some space. Then run the same command again to continue."
            )
            raise DiskError(message) from error
        return file

    def others(self, mine: set[str]) -> int:
        """Return the number of stored results whose pages are not in `mine`."""
        found = {file.with_suffix(".html").name for file in (self.folder / REPORTS).glob("*.json")}
        return len(found - mine)


@contextmanager
def opened(folder: Path, submissions: Sequence[Path] = (), *, chosen: bool = True) -> Iterator[Results]:
    """Create the folder if necessary, lock it against other runs, and yield it.

    `submissions` are the folders of the class, in which a student could have put a folder with forged results.
    If the user has `chosen` the folder, the messages advise choosing another one.

        with opened(Path("grades")) as results:
            old = results.load("anna", "03-circle-publisher")

    Raises:
        UsageError: another run is using the folder, it is not a folder, it contains files that are not results, or a
            student could have created it.
        MachineError: the folder cannot be written.
    """
    lock, new = folder / MARK, not os.path.lexists(folder)
    marked = os.path.lexists(lock)  # perhaps by a student, if it is the folder of the submissions
    among = is_among(folder, submissions) or (marked and any(is_same(folder, each) for each in submissions))
    if not new and among and (folder.is_symlink() or not has_results(folder)):
        message = (
            f"{folder} is among the submissions, and nothing shows that you created it with `grader grade`: a student "
            "may have put forged results there. Choose another folder with --out."
        )
        raise UsageError(message)
    if folder.exists() and not folder.is_dir():
        message = f"{folder} is not a folder. "
        message += "Choose a new folder with --out." if chosen else "Move it to another folder."
        raise UsageError(message)
    killed = {f".{MARK}{PARTIAL}"}  # a run that was killed before it had marked the folder left this file
    if folder.exists() and not lock.exists() and {each.name for each in folder.iterdir()} - killed:
        message = f"{folder} contains files that are not results of `grader grade`. "
        message += "Choose a new folder with --out." if chosen else "Move them to another folder."
        raise UsageError(message)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)  # marks and hidden checks are not for other users of the machine
        if not lock.exists():
            mark(lock, needed=among)
        (folder / REPORTS).mkdir(exist_ok=True)
        file = lock.open("a")
    except OSError as error:
        if new and not has_results(folder):
            with suppress(OSError):
                folder.rmdir()  # otherwise, the next run could not use it
        todo = "Free some space" if error.errno in (errno.ENOSPC, errno.EDQUOT) else "Make the folder writable"
        instead = ", or choose another folder with --out" if chosen else ""
        path = str(error.filename or folder)
        where = "" if path.startswith(str(folder)) else f" ({path})"  # the list of marks
        message = f"The results cannot be written to {folder}: {error.strerror}{where}. {todo}{instead}."
        raise MachineError(message) from error
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            instead = ", or choose another folder with --out" if chosen else ""
            message = f"Another `grader grade` or `grader gradebook sync` is using {folder}. Let it finish{instead}."
            raise UsageError(message) from error
        for leftover in folder.rglob(f"*{PARTIAL}"):
            leftover.unlink(missing_ok=True)
        yield Results(folder)


def _encodable(text: str) -> str:
    return text.encode("utf-8", "backslashreplace").decode("utf-8")

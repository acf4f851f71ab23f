"""The results of a class on the disk: one JSON and one page a submission, each written whole or not at all.

    OUT/reports/STUDENT.EXERCISE.json   the report (grader.report.json) with two keys more: student, and key (key.py);
                                        for the instructor: hidden checks stand in it; `errors` says how often in a
                                        row it ended with an error
    OUT/reports/STUDENT.EXERCISE.html   its page, without what is hidden

The JSON is written after the page: where it stands, the result is finished. What a killed run was writing has the
ending .partial, and the next run takes it away. One run at a time works on a folder.
"""

from __future__ import annotations

import fcntl
import json
import os
import re
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.errors import DiskError, MachineError, UsageError
from grader.report.json import from_json, to_data
from grader.report.suspicion import ERRORS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from grader.classroom.key import Key
    from grader.report.report import Report

REPORTS = "reports"
_LOCK = ".grader-results"
_PARTIAL = ".partial"
_SAFE = re.compile(r"[^A-Za-z0-9 _@+,=-]")
_LONGEST = 120
"""Bytes of a file's name; longer ones are cut, and told apart by what was cut off."""


@dataclass(frozen=True)
class Result:
    """A graded submission; `page` is its file's name below reports/."""

    student: str
    report: Report
    key: Mapping[str, Any]
    page: str
    errors: int = 0
    """How often in a row its grading has ended with an `error`, this time included."""


def file_name(student: str, exercise: str) -> str:
    """The name of a result's files without their ending: no two students share one, and every disk takes it."""
    # What is replaced is kept as a number, so that two names never become one; a dot would look like an ending.
    safe = _SAFE.sub(lambda match: "".join(f"%{byte:02X}" for byte in os.fsencode(match.group())), student)
    if len(safe) > _LONGEST:
        import hashlib

        safe = f"{safe[: _LONGEST - 20]}%%{hashlib.sha256(os.fsencode(student)).hexdigest()[:16]}"
    return f"{safe}.{exercise}"


@dataclass(frozen=True)
class Results:
    """The folder that results go to; `opened` gives one."""

    folder: Path

    def load(self, student: str, exercise: str) -> Result | None:
        """The finished result of a submission, whatever its key; None where there is none."""
        name = file_name(student, exercise)
        file = self.folder / REPORTS / f"{name}.json"
        try:
            text = file.read_text(encoding="utf-8")
            data = json.loads(text)
            if data["student"] != _encodable(student) or not file.with_suffix(".html").is_file():
                return None
            return Result(student, from_json(text), data["key"], f"{name}.html", int(data.get(ERRORS, 0)))
        except (OSError, ValueError, KeyError, TypeError, UsageError):
            return None  # damaged, or of another grader: made again

    def save(self, student: str, report: Report, key: Key, page: bytes, errors: int = 0) -> Result:
        """Write a result. Raises MachineError where the disk is full or forbids it."""
        name = file_name(student, report.exercise)
        data = {**to_data(report), "student": _encodable(student), "key": key.to_data(), ERRORS: errors}
        self.write(f"{REPORTS}/{name}.html", page)
        text = json.dumps(data, ensure_ascii=False, indent=1) + "\n"
        self.write(f"{REPORTS}/{name}.json", text.encode("utf-8", "backslashreplace"))
        return Result(student, report, key.to_data(), f"{name}.html", errors)

    def write(self, name: str, content: bytes) -> Path:
        """Write a file of the folder, whole or not at all. Raises MachineError where that cannot be done."""
        file = self.folder / name
        partial = file.with_name(file.name + _PARTIAL)
        try:
            file.parent.mkdir(exist_ok=True)
            with partial.open("wb") as opened:
                opened.write(content)
                opened.flush()
                os.fsync(opened.fileno())
            partial.replace(file)
        except OSError as error:
            with suppress(OSError):
                partial.unlink()
            message = (
                f"{file} could not be written: {error.strerror}. What was graded before is kept; make room, and the "
                "same command goes on from there."
            )
            raise DiskError(message) from error
        return file

    def others(self, mine: set[str]) -> int:
        """How many results in the folder belong to none of these pages: of submissions that are not named now."""
        found = {file.with_suffix(".html").name for file in (self.folder / REPORTS).glob("*.json")}
        return len(found - mine)


@contextmanager
def opened(folder: Path) -> Iterator[Results]:
    """The folder, made where it is not there; nobody else's run works on it meanwhile.

    Raises:
        UsageError: another run works on it, or it holds something else than results.
        MachineError: it cannot be written.
    """
    lock = folder / _LOCK
    if folder.exists() and not (folder.is_dir() and (lock.exists() or not any(folder.iterdir()))):
        message = f"{folder} holds something else than results of `grader grade`. Name a new folder with --out."
        raise UsageError(message)
    try:
        (folder / REPORTS).mkdir(parents=True, exist_ok=True)
        file = lock.open("a")
    except OSError as error:
        message = f"The results cannot be written to {folder}: {error.strerror}."
        raise MachineError(message) from error
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            message = f"Another `grader grade` works on {folder} now. Wait for it, or name another folder with --out."
            raise UsageError(message) from error
        for leftover in folder.rglob(f"*{_PARTIAL}"):
            leftover.unlink(missing_ok=True)
        yield Results(folder)


def _encodable(text: str) -> str:
    return text.encode("utf-8", "backslashreplace").decode("utf-8")

"""Read the reports of a class: the JSON files below a folder.

Students can write these files, so processes with limits read them in batches (grader.submission.reader). A file that
cannot be read is left out, with the reason, and the other files are read.
"""

from __future__ import annotations

import json
import os
import re
import stat
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from grader.checks.outcome import Status
from grader.common.words import shorten
from grader.errors import UnreadableError, UsageError
from grader.report.json import from_json
from grader.report.suspicion import ERRORS, suspicions
from grader.report.verdict import tone, verdict
from grader.submission.reader import read
from grader.submission.tree import MAX_PATH_BYTES, shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.checks.outcome import Outcome
    from grader.report.report import Report

MB = 1_000_000
LARGEST = 4 * MB
"""The maximum size of a report (bytes). The grader never writes a larger report."""
MOST_BYTES = 100 * MB
"""When the reports that were read have more than this size in total (bytes), all larger reports are left out."""
MOST_AT_ONCE, MOST_BYTES_AT_ONCE = 500, 8 * MB
"""The maximum number and size of the files that one reading process reads."""
MOST_FOUND = 100_000
"""The maximum number of files and folders that are searched for reports."""
MOST_REASON = 300
MOST_LINES = 20
"""The maximum number of files that are listed when files are left out. Further files are only counted."""


@dataclass(frozen=True)
class Entry:
    """A report of the class. `link` is the link from the class page to the submission's page, or an empty string."""

    report: Report
    name: str
    link: str
    attention: str = ""
    """The reason why an instructor should check the submission, or an empty string."""

    @property
    def share(self) -> float:
        """The fraction of all points that the submission earned, from 0 to 1."""
        return self.report.points / self.report.max if self.report.max else 0.0

    @property
    def tone(self) -> str:
        """The kind of verdict: "passed", "failed" or "error"."""
        return tone(self.report)

    @property
    def verdict(self) -> str:
        """The verdict in one line."""
        return verdict(self.report)

    @property
    def failed(self) -> tuple[Outcome, ...]:
        """The failed checks, without the checks that were skipped because another check failed."""
        return self.report.with_status(Status.FAILED)

    @property
    def first_error(self) -> str:
        """The message of the first machine error, or an empty string."""
        errors = self.report.with_status(Status.ERROR)
        return errors[0].finding.observed if errors else ""


@dataclass(frozen=True)
class ClassReports:
    """The reports below a folder, and the files and folders that were left out, each with the reason."""

    entries: tuple[Entry, ...]
    left_out: tuple[tuple[str, str], ...]

    @property
    def lines(self) -> list[str]:
        """A line for each of the first files that were left out, and a line with the number of the others."""
        lines = [f"Left out: {name}: {reason.rstrip('.')}." for name, reason in self.left_out[:MOST_LINES]]
        more = len(self.left_out) - MOST_LINES
        return [*lines, f"Left out: {more} more, see the page."] if more > 0 else lines


@dataclass(frozen=True)
class _Found:
    """A report in a file. `errors` is the number of consecutive gradings that ended with an error."""

    name: str
    report: Report
    errors: int


@dataclass(frozen=True)
class _LeftOut:
    """A file, or another place, that was left out, with the reason."""

    name: str
    reason: str


def read_class(folder: Path) -> ClassReports:
    """Return the reports below the folder, sorted by name, and the files and folders that were left out.

    Raises:
        UsageError: there is no such folder, or it contains neither reports nor files that were left out.
        MachineError: the machine failed while reading.
    """
    if not folder.is_dir():
        message = f"There is no folder {folder}. Give the folder that contains the reports from `grader check --json`."
        raise UsageError(message)
    files, left_out = read(_files_in, folder)
    found: list[_Found] = []
    for each in _all(folder, files):
        if isinstance(each, _Found):
            found.append(each)
        else:
            left_out.append(each)
    if not found and not left_out:
        message = f"There is no report below {folder}: `grader check --json FILE` writes one."
        raise UsageError(message)
    found.sort(key=lambda each: Path(each.name))
    names = _short([each.report.submission for each in found])
    attention = suspicions([(each.report, each.errors) for each in found])
    entries = [
        Entry(each.report, name, _link(folder / each.name, folder), why)
        for each, name, why in zip(found, names, attention, strict=True)
    ]
    without = sorted((shorten(shown(each.name), MOST_REASON), shorten(each.reason, MOST_REASON)) for each in left_out)
    return ClassReports(tuple(sorted(entries, key=lambda entry: _natural(entry.name))), tuple(without))


def _files_in(folder: Path) -> tuple[list[tuple[str, int]], list[_LeftOut]]:
    """Return the JSON files below the folder, each with its size, and what is left out of the search.

    The folders near the top come first. Links to folders are not followed.
    """
    files: list[tuple[str, int]] = []
    left_out: list[_LeftOut] = []
    waiting = deque([""])
    left = MOST_FOUND
    while waiting:
        below = waiting.popleft()
        try:
            with os.scandir(folder / below) as listing:
                for entry in listing:
                    left -= 1
                    if left < 0:
                        reason = f"the search for reports ended here, after {MOST_FOUND} files and folders"
                        return files, [*left_out, _LeftOut(below or ".", reason)]
                    name = os.path.join(below, entry.name)  # noqa: PTH118 - a Path for each entry takes too long
                    if len(os.fsencode(name)) > MAX_PATH_BYTES:
                        left_out.append(_LeftOut(name, f"its path has more than {MAX_PATH_BYTES} bytes"))
                    elif entry.is_dir(follow_symlinks=False):
                        waiting.append(name)
                    elif name.endswith(".json") and not _leads_to_folder(entry):
                        files.append((name, _size(entry)))
        except OSError as error:
            left_out.append(_LeftOut(below or ".", f"the folder could not be searched ({error.strerror})"))
    return files, left_out


def _leads_to_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # for example, a link to itself
        return False  # reading the file will report the reason


def _size(entry: os.DirEntry[str]) -> int:
    try:
        return entry.stat().st_size
    except OSError:
        return 0  # reading the file will report the reason


def _all(folder: Path, files: Sequence[tuple[str, int]]) -> Iterator[_Found | _LeftOut]:
    """Read the files, the smallest first, so that large files do not take the place of small ones."""
    sizes = dict(files)
    total = 0
    for names in _batches(sorted(files, key=lambda each: each[1])):
        if total > MOST_BYTES:
            reason = f"and the smaller reports already have more than {MOST_BYTES // MB} MB"
            yield from (_LeftOut(name, f"it has {sizes[name] / MB:.1f} MB, {reason}") for name in names)
            continue
        for each in _batch(folder, names):
            total += sizes[each.name] if isinstance(each, _Found) else 0
            yield each


def _batches(files: Sequence[tuple[str, int]]) -> Iterator[list[str]]:
    names: list[str] = []
    total = 0
    for name, size in files:
        if names and (total + size > MOST_BYTES_AT_ONCE or len(names) == MOST_AT_ONCE):
            yield names
            names, total = [], 0
        names.append(name)
        total += size
    if names:
        yield names


def _batch(folder: Path, names: list[str]) -> list[_Found | _LeftOut]:
    """Read some files in one process. If this fails, read each half alone, to find the file that is the reason."""
    try:
        return read(_reports_in, folder, names)
    except UnreadableError as error:
        if len(names) == 1:
            return [_LeftOut(names[0], str(error))]
    half = len(names) // 2
    return [*_batch(folder, names[:half]), *_batch(folder, names[half:])]


def _reports_in(folder: Path, names: Sequence[str]) -> list[_Found | _LeftOut]:
    """Read these files in this process, without files that are not reports."""
    return [found for name in names if (found := _report_in(folder, name)) is not None]


def _report_in(folder: Path, name: str) -> _Found | _LeftOut | None:
    try:
        text = _text(folder / name)
        if '"outcomes"' not in text:
            return None  # a JSON file that is not a report
        return _Found(name, from_json(text), int(json.loads(text).get(ERRORS, 0)))
    except (OSError, ValueError, TypeError, AttributeError, OverflowError, RecursionError, UsageError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return _LeftOut(name, reason[: 4 * MOST_REASON])


def _text(file: Path) -> str:
    """Return the text of a report. Raises OSError or UnicodeError.

    Raises UnreadableError if the file is too large, or is not a regular file.
    """
    descriptor = os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with os.fdopen(descriptor, "rb") as opened:
        about = os.fstat(descriptor)
        if not stat.S_ISREG(about.st_mode):
            message = "it is not a regular file"
            raise UnreadableError(message)
        data = opened.read(LARGEST + 1)
    if len(data) > LARGEST:
        message = f"it has {about.st_size / MB:.1f} MB, and a report has at most {LARGEST // MB} MB"
        raise UnreadableError(message)
    return data.decode("utf-8")


def _natural(name: str) -> list[tuple[int, str]]:
    """Return a sort key for the order that people expect (2 before 10, A next to a), as in the page's script."""
    parts = re.findall(r"[0-9]{1,18}|[^0-9]+", name.casefold())
    return [(int(part), "") if part[0] in "0123456789" else (-1, part) for part in parts]


def _short(names: Sequence[str]) -> list[str]:
    """Return the names without the leading and trailing folders that all names share."""
    parts = [name.rstrip("/").split("/") for name in names]
    if len(parts) < 2:
        return list(names)
    ends = _alike([each[::-1] for each in parts])
    begins = _alike([each[: len(each) - ends] for each in parts])
    return ["/".join(each[begins : len(each) - ends]) or name for each, name in zip(parts, names, strict=True)]


def _alike(paths: Sequence[Sequence[str]]) -> int:
    """Return the number of leading folders that all paths share, not counting the last part of a path."""
    same = 0
    for level in zip(*(path[:-1] for path in paths), strict=False):
        if len(set(level)) > 1:
            break
        same += 1
    return same


def _link(file: Path, folder: Path) -> str:
    page = file.with_suffix(".html")
    # A link must never be read as a URL with a scheme: "./" makes it a relative path.
    return "./" + quote(page.relative_to(folder).as_posix(), errors="surrogateescape") if page.is_file() else ""

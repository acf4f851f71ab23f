"""The page of a class of students, made from reports: points, common failures with their causes, and machine errors.

The reports are the JSON files below a folder. If there is a page with the same name next to a report, the class page
links to that page.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import dataclass, field
from statistics import median
from typing import TYPE_CHECKING
from urllib.parse import quote

from markupsafe import Markup

from grader.checks.outcome import Status
from grader.errors import UsageError
from grader.report.html_page import make_page, save_page
from grader.report.json import from_json
from grader.report.suspicion import ERRORS, suspicions
from grader.report.svg import picture, tag, words
from grader.report.verdict import tone, verdict
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from grader.checks.outcome import Outcome
    from grader.report.report import Report

LARGEST = 4_000_000
"""The maximum size of a file that may be a report (bytes). Every report is smaller."""
PAGE = "index.html"
MOST_DIAGNOSES = 5
BAR = "#1c7ed6"


@dataclass(frozen=True)
class Entry:
    """A report of the class. `link` is the link from the class page to the submission's page, or an empty string."""

    report: Report
    name: str
    link: str
    attention: str = ""
    """The reason why an instructor should check the submission."""

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


@dataclass
class Diagnosis:
    """A cause of failed checks: its stable id, its messages (with the number of each), and the affected submissions."""

    id: str
    texts: Counter[str] = field(default_factory=Counter)
    entries: list[Entry] = field(default_factory=list)
    changes: list[tuple[Entry, str]] = field(default_factory=list)
    """The submissions in which a change proved this cause, each with the change as a unified diff."""

    @property
    def text(self) -> str:
        """The most frequent message for this cause."""
        return self.texts.most_common(1)[0][0] if self.texts else ""


@dataclass
class FailedCheck:
    """A check that at least one submission failed, with its causes."""

    exercise: str
    id: str
    title: str
    entries: list[Entry] = field(default_factory=list)
    by_cause: dict[str, Diagnosis] = field(default_factory=dict)

    @property
    def diagnoses(self) -> list[Diagnosis]:
        """The most frequent causes, sorted by frequency."""
        ordered = sorted(self.by_cause.values(), key=lambda each: (-len(each.entries), each.id))
        return ordered[:MOST_DIAGNOSES]


@dataclass(frozen=True)
class ClassReports:
    """The reports below a folder, and the files that are probably reports but cannot be read, each with the reason."""

    entries: tuple[Entry, ...]
    unreadable: tuple[tuple[str, str], ...]


def read_class(folder: Path) -> ClassReports:
    """Read every report below the folder, sorted by name. Raises UsageError if there is no folder or no report."""
    if not folder.is_dir():
        message = f"There is no folder {folder}. Give the folder that contains the reports from `grader check --json`."
        raise UsageError(message)
    found: list[tuple[Path, Report]] = []
    errors: list[int] = []
    unreadable: list[tuple[str, str]] = []
    for file in sorted(folder.rglob("*.json")):
        try:
            if not file.is_file() or file.stat().st_size > LARGEST:
                continue
            text = file.read_text(encoding="utf-8")
            if '"outcomes"' not in text:
                continue  # a JSON file that is not a report
            one, amount = from_json(text), int(json.loads(text).get(ERRORS, 0))
            found.append((file, one))
            errors.append(amount)
        except (OSError, ValueError, TypeError, AttributeError, OverflowError, RecursionError, UsageError) as error:
            unreadable.append((str(file.relative_to(folder)), str(error)))
    if not found and not unreadable:
        message = f"There is no report below {folder}: `grader check --json FILE` writes one."
        raise UsageError(message)
    names = _short([report.submission for _, report in found])
    attention = suspicions([(report, amount) for (_, report), amount in zip(found, errors, strict=True)])
    entries = [
        Entry(report, name, _link(file, folder), why)
        for (file, report), name, why in zip(found, names, attention, strict=True)
    ]
    return ClassReports(tuple(sorted(entries, key=lambda entry: _natural(entry.name))), tuple(unreadable))


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


def failures(entries: Iterable[Entry]) -> list[FailedCheck]:
    """Return the failed checks, the most frequent first."""
    checks: dict[tuple[str, str], FailedCheck] = {}
    for entry in entries:
        for outcome in entry.failed:
            key = (entry.report.exercise, outcome.id)
            check = checks.setdefault(key, FailedCheck(*key, outcome.title))
            check.entries.append(entry)
            cause = outcome.finding.diagnosis or "unknown"
            diagnosis = check.by_cause.setdefault(cause, Diagnosis(cause))
            diagnosis.entries.append(entry)
            if outcome.finding.change:
                diagnosis.changes.append((entry, outcome.finding.change))
            diagnosis.texts[outcome.finding.cause or outcome.finding.observed] += 1
    return sorted(checks.values(), key=lambda check: (-len(check.entries), check.exercise, check.id))


def class_page(reports: ClassReports) -> str:
    """Return the page as a string."""
    judged = [entry for entry in reports.entries if entry.tone != "error"]
    broken = [entry for entry in reports.entries if entry.tone == "error"]
    exercises = sorted({entry.report.exercise for entry in reports.entries})
    shares = [entry.share for entry in judged]
    values = {
        "rows": reports.entries,
        "entries": judged,
        "broken": broken,
        "attention": [entry for entry in reports.entries if entry.attention],
        "unreadable": reports.unreadable,
        "exercises": exercises,
        "failures": failures(judged),
        "passed": sum(entry.tone == "passed" for entry in judged),
        "mean": sum(shares) / len(shares) if shares else 0.0,
        "middle": median(shares) if shares else 0.0,
        "distribution": Markup(distribution(shares)) if shares else "",
        "caption": _in_words(shares),
    }
    return make_page("class.html", ("class.js",), {}, values)


def save_class_page(folder: Path, file: Path) -> None:
    """Write the page for the reports below a folder.

    Raises:
        UsageError: there is no report, or the path of the page is not valid or not writable.
        MachineError: the disk is full, or the machine failed in another way.
    """
    save_page(class_page(read(read_class, folder)), file)


BINS = [f"{10 * each} to {10 * each + 9}" for each in range(10)] + ["100"]


def counts(shares: Iterable[float]) -> list[int]:
    """Count the submissions with 0 to 9 % of the points, 10 to 19 %, and so on. The last count is for full marks."""
    found = [0] * len(BINS)
    for share in shares:
        found[min(int(share * 10 + 1e-9), 10)] += 1
    return found


def _in_words(shares: Iterable[float]) -> str:
    groups = [f"{amount} got {name} %" for name, amount in zip(BINS, counts(shares), strict=True) if amount]
    return f"Share of the points: {'; '.join(groups)}." if groups else "No submission was judged."


def distribution(shares: Iterable[float]) -> str:
    """Draw a bar chart of the number of submissions in each range of percentages."""
    found = counts(shares)
    width, height, top, bar = 560.0, 170.0, 24.0, 46.0
    most = max(*found, 1)
    parts = []
    for index, (name, amount) in enumerate(zip(BINS, found, strict=True)):
        x, tall = 12 + index * (bar + 3), height * amount / most
        if amount:
            parts.append(tag("rect", x=x, y=top + height - tall, width=bar, height=tall, fill=BAR))
            parts.append(words(str(amount), x + bar / 2, top + height - tall - 6, "middle"))
        parts.append(words(name.split()[0], x + bar / 2, top + height + 19, "middle"))
    base = tag("path", d=f"M8 {top + height}H{width - 8}", stroke="currentColor")
    label = words("% of the points (the last bar: 100 %)", width - 10, top + height + 40, "end")
    return picture(
        *parts,
        base,
        label,
        width=width,
        height=top + height + 44,
        title="Distribution of points",
        key="distribution",
        name="distribution",
    )

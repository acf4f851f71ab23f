"""The page of a class of students, made from reports: points, common failures with their causes, and machine errors."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from statistics import median
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.report.class_reports import read_class
from grader.report.html_page import make_page, save_page
from grader.report.svg import picture, tag, words

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from grader.report.class_reports import ClassReports, Entry

PAGE = "index.html"
MOST_DIAGNOSES = 5
MOST_LEFT_OUT = 200
"""The maximum number of files that are listed because they were left out. Further files are only counted."""
BAR = "#1c7ed6"


@dataclass
class Diagnosis:
    """A cause of failed checks: its stable id, its messages (with the number of each), and the affected submissions."""

    id: str
    texts: Counter[str] = field(default_factory=Counter)
    entries: list[Entry] = field(default_factory=list)
    changes: list[tuple[Entry, str]] = field(default_factory=list)
    """The submissions in which a change confirmed this cause, each with the change as a unified diff."""

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
        "left_out": reports.left_out[:MOST_LEFT_OUT],
        "more_left_out": max(0, len(reports.left_out) - MOST_LEFT_OUT),
        "exercises": exercises,
        "failures": failures(judged),
        "passed": sum(entry.tone == "passed" for entry in judged),
        "mean": sum(shares) / len(shares) if shares else 0.0,
        "middle": median(shares) if shares else 0.0,
        "distribution": Markup(distribution(shares)) if shares else "",
        "caption": _in_words(shares),
    }
    return make_page("class.html", ("class.js",), {}, values)


def save_class_page(folder: Path, file: Path) -> list[str]:
    """Write the page for the reports below a folder. Return the lines about files that were left out.

    Raises:
        UsageError: there is no report, or the path of the page is not valid or not writable.
        MachineError: the disk is full, or the machine failed in another way.
    """
    reports = read_class(folder)
    save_page(class_page(reports), file)
    return reports.lines


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

"""A class as a table: one line a submission, for a spreadsheet or a gradebook. For the instructor.

    submission  the name of the folder or archive
    exercise    its id
    points      what was got
    max         the points of the whole exercise, whatever could be judged
    percent     of that
    status      passed, failed, or error: graded again by the next run
    failed      ids of the checks that failed, in the order of the exercise, blanks between
    diagnoses   the stable ids of their causes
    first       what was seen by the first of them, in words
    clock, seed
    graded_by   the grader's version and the beginning of its sources' sha256
    report      the file of the whole report
    attention   why an instructor should look at it: "suspicious" where the grader failed at it again and again

No cell is a formula, whatever a student wrote.
"""

from __future__ import annotations

import csv
import io
import unicodedata
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.common.words import printable
from grader.report.verdict import tone

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.report.report import Report

COLUMNS = (
    "submission",
    "exercise",
    "points",
    "max",
    "percent",
    "status",
    "failed",
    "diagnoses",
    "first",
    "clock",
    "seed",
    "graded_by",
    "report",
    "attention",
)
FORMULA = frozenset({"=", "+", "-", "@", "\N{MINUS SIGN}"})
SEPARATORS = frozenset({";", "|", "\t", "\r", "\n"})
BEFORE = frozenset({"", '"', "'", "`"})
"""What may stand before a formula's first character: blanks, and quotes that a reader takes off."""


def to_csv(rows: Iterable[tuple[str, Report, str, str, str]]) -> str:
    """The table of these students, reports, graders, names of JSON files, and why to look at them.

    It begins with a mark that tells Excel of UTF-8.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")  # as RFC 4180 has it
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow([_safe(str(value)) for value in _row(*row)])
    return "\ufeff" + text.getvalue()


def _row(student: str, report: Report, grader: str, file: str, attention: str) -> tuple[object, ...]:
    failed = report.with_status(Status.FAILED) or report.with_status(Status.ERROR)
    return (
        student,
        report.exercise,
        f"{report.points:g}",
        f"{report.max:g}",
        f"{100 * report.points / report.max if report.max else 0:.1f}",
        tone(report),
        " ".join(outcome.id for outcome in failed),
        " ".join(dict.fromkeys(outcome.finding.diagnosis or "" for outcome in failed)).strip(),
        failed[0].finding.observed if failed else "",
        report.clock,
        "" if report.seed is None else report.seed,
        grader,
        file,
        attention,
    )


def _safe(text: str) -> str:
    """One line, and no formula: spreadsheets run what begins like one (CWE-1236).

    Where a reader takes another character than the comma for a separator, a cell begins behind each of those too. What
    is full width or small counts as what it is a variant of: some spreadsheets normalize it on input.
    """
    begins, line = True, ""
    for char in printable(text):
        plain = unicodedata.normalize("NFKC", char).strip()
        if begins and plain in FORMULA:
            line += "'"
        begins = plain in SEPARATORS or (begins and plain in BEFORE)
        line += char
    return line

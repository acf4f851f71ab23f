"""The results of a course's students as a CSV table, for a spreadsheet or gradebook: one line per submission.

    submission  the name of the folder or archive
    exercise    the id of the exercise
    points      the points that the submission earned
    max         the points of the whole exercise, including checks that could not be judged
    percent     points as a percentage of max
    status      passed, failed, or error; a submission with an error is graded again by the next run
    failed      the ids of the failed checks or, if no check failed, of the checks that could not be judged, in the
                order of the exercise and separated by spaces
    diagnoses   the stable ids of the causes of these checks
    first       what the first of these checks observed, in words
    clock, seed
    graded_by   the version of the grader and the first digits of the sha256 of its sources
    report      the file with the full report
    attention   the reason why an instructor should check the submission, or nothing

No cell is ever a formula, regardless of what a student wrote.
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
"""Characters that may precede a formula: spaces, and quotes that a spreadsheet removes."""


def to_csv(rows: Iterable[tuple[str, Report, str, str, str]]) -> str:
    """Return the table for rows of (student, report, grader, name of the JSON file, reason to check the submission).

    The table begins with a byte order mark, so that Excel reads it as UTF-8.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")  # RFC 4180 specifies these line endings.
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow([without_formula(str(value)) for value in _row(*row)])
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


def without_formula(text: str) -> str:
    """Return the text on one line, changed so that no spreadsheet executes it as a formula (CWE-1236).

    A spreadsheet can split cells at a separator other than the comma. Therefore, the text after each separator in
    SEPARATORS is checked as if a new cell began there. Full-width and small variants of characters are treated like the
    standard characters, because some spreadsheets normalize them on import.
    """
    begins, line = True, ""
    for char in printable(text):
        plain = unicodedata.normalize("NFKC", char).strip()
        if begins and plain in FORMULA:
            line += "'"
        begins = plain in SEPARATORS or (begins and plain in BEFORE)
        line += char
    return line

"""A report for GitHub Actions: the step's summary in Markdown, and annotations as workflow commands.

The summary and the annotations contain text from a student, which must never be interpreted as Markdown or as a
command. In the summary, this text is always plain text. In a command, the text is escaped as described in GitHub's
documentation ("Workflow commands for GitHub Actions") and as implemented by `escapeData` and `escapeProperty` in
GitHub's toolkit. For a hidden check, only the result and the points are included.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.common.words import count, printable, shorten
from grader.report.certainty import cause_sentence
from grader.report.hidden import for_students
from grader.report.verdict import verdict

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from grader.checks.outcome import Outcome
    from grader.report.report import Report

MOST_SUMMARY = 900_000
"""The maximum size of a summary (bytes). GitHub allows one MiB per step."""
MOST_ANNOTATIONS = 10
"""The maximum number of annotations of each kind per step. GitHub does not show more."""
LONGEST = 300
_MARKDOWN = re.compile(r"([\\`*_{}\[\]()#+\-.!|<>~&@:$^=])")
_SIGNS = {Status.PASSED: "✅", Status.FAILED: "❌", Status.SKIPPED: "\N{HEAVY MINUS SIGN}", Status.ERROR: "⚠️"}


def to_summary(rows: Sequence[tuple[str, Report]]) -> str:
    """Return Markdown for $GITHUB_STEP_SUMMARY: a table of all submissions, and the checks of as many as fit."""
    parts = ["| submission | exercise | points | |\n| --- | --- | ---: | --- |\n"]
    for student, report in rows:
        points = f"{report.points:g} of {report.max:g}"
        parts.append(f"| {_text(student)} | {_text(report.exercise)} | {points} | {_text(verdict(report))} |\n")
    size = sum(len(part.encode()) for part in parts)
    for number, (student, report) in enumerate(rows):
        part = _details(student, for_students(report))
        size += len(part.encode())
        if size > MOST_SUMMARY:
            parts.append(f"\nThe checks of {count(len(rows) - number, 'more submission')} do not fit here.\n")
            break
        parts.append(part)
    return "".join(parts)


def _details(student: str, report: Report) -> str:
    lines = [
        f"\n### {_text(student)}: {_text(report.exercise_title)}\n",
        "| | check | points | |",
        "| --- | --- | ---: | --- |",
    ]
    for outcome in report.outcomes:
        sign = (
            "\N{INFORMATION SOURCE}" if outcome.advice and outcome.status is Status.FAILED else _SIGNS[outcome.status]
        )
        points = f"{outcome.points:g}/{outcome.max:g}" if outcome.max else ""
        lines.append(f"| {sign} | {_text(outcome.title)} | {points} | {_reported(outcome)} |")
    return "\n".join(lines) + "\n"


def _reported(outcome: Outcome) -> str:
    finding = outcome.finding
    if outcome.status is Status.PASSED:
        return ""
    where = f"({finding.where})" if finding.where else ""
    return _text(
        " ".join(text for text in (finding.observed, finding.expected, cause_sentence(outcome), where) if text)
    )


def _text(text: str) -> str:
    """Escape text for Markdown, including tables, so that it contains no links, HTML or mentions."""
    # Markdown and GitHub treat numeric character references as plain text, never as Markdown, mentions or emoji.
    return _MARKDOWN.sub(lambda sign: f"&#{ord(sign.group())};", shorten(text, LONGEST))


def to_annotations(rows: Iterable[tuple[str, Report]], folder: str = "") -> str:
    """Return workflow commands, one per line: errors for failed checks, and warnings for those with the status `error`.

    There are at most MOST_ANNOTATIONS of each kind. Advice is left out.

    `folder` is the path of the package in the repository. GitHub needs this path to show an annotation next to the
    line.
    """
    errors: list[str] = []
    warnings: list[str] = []
    for student, report in rows:
        for outcome in for_students(report).outcomes:
            if outcome.advice:
                continue
            if outcome.status is Status.FAILED:
                errors.append(_command("error", student, outcome, folder))
            elif outcome.status is Status.ERROR:
                warnings.append(_command("warning", student, outcome, folder))
    return "".join(f"{line}\n" for line in (*errors[:MOST_ANNOTATIONS], *warnings[:MOST_ANNOTATIONS]))


def _command(kind: str, student: str, outcome: Outcome, folder: str) -> str:
    where = outcome.finding.where
    properties = {"title": shorten(f"{student}: {outcome.title}", LONGEST)}
    if where is not None and folder:
        properties["file"] = printable(f"{folder.rstrip('/')}/{where.file}")
        if where.line is not None:
            properties["line"] = str(where.line)
    finding = outcome.finding
    message = shorten(
        " ".join(text for text in (finding.observed, finding.expected, cause_sentence(outcome)) if text), 3 * LONGEST
    )
    joined = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    return f"::{kind} {joined}::{_data(message)}"


def _data(text: str) -> str:
    escaped = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    # GitHub recognizes an older form of command anywhere in a line.
    return escaped.replace("##[", "# #[")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")

"""Report to the terminal: every check on a line, what to mend below it, the verdict last, where the eye rests.

On a terminal with colours and a hanging indent; piped, the same words on one line each. All that a student wrote is
printed as plain text: no markup, no control characters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from grader.checks.outcome import Outcome, Status
from grader.common.words import count, printable
from grader.report.verdict import UNCONFINED, tone, verdict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from grader.report.report import Report

NARROW = 50
"""Columns: below, texts are not indented under their labels."""

SIGNS = {"passed": "✓", "failed": "✗", "skipped": "-", "error": "!", "advice": "i"}
ASCII_SIGNS = {"passed": "ok", "failed": "FAIL", "skipped": "skip", "error": "ERROR", "advice": "note"}
STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "error": "bold magenta", "advice": "cyan"}


def render(report: Report, console: Console, *, brief: bool = False, verbose: bool = False) -> None:
    """Print the report: of the checks only those that did not pass when `brief`, the clock always when `verbose`."""
    _line(console, Text(printable(f"{report.exercise_title}: {report.submission}"), style="bold"))
    told = ""
    for outcome in report.outcomes:
        if not (brief and _look(outcome) in ("passed", "skipped")):
            _check(outcome, console, told)
        told = outcome.finding.observed
    console.print()
    if brief:
        amount = count(len(report.with_status(Status.PASSED)), "check")
        _line(
            console, Text(f"{amount} passed. In a higher window, or with `grader check`, all are listed.", style="dim")
        )
    _line(console, _verdict(report))
    for text in _footnotes(report, verbose=verbose):
        _line(console, Text(text, style="dim"))


def early(outcomes: Sequence[Outcome]) -> list[str]:
    """Lines on what the files alone tell, to be read while the rest is built and run."""
    told = [(outcome, outcome.finding) for outcome in outcomes if not outcome.hidden]
    lines = [
        f"{outcome.title}: {finding.observed}" + (f" ({finding.where})" if finding.where else "")
        for outcome, finding in told
    ]
    return [printable(f"Not right, as the files say: {line}") for line in lines]


def _look(outcome: Outcome) -> str:
    """How the outcome is told: its status, or "advice" for advice that was not followed."""
    if outcome.advice and outcome.status is Status.FAILED:
        return "advice"
    return outcome.status.value


def _check(outcome: Outcome, console: Console, told: str) -> None:
    """One check. What was `told` of the check before it is not said again: one cause may stop many."""
    look = _look(outcome)
    signs = SIGNS if console.encoding.lower().startswith("utf") else ASCII_SIGNS
    head = Text(f"{signs[look]} ", style=STYLES[look])
    head.append(printable(outcome.title), style="" if look == "passed" else "bold")
    if outcome.max:
        points = f"{_points(outcome.points)}/{_points(outcome.max)}" + (" so far" if look == "error" else "")
        head.append(f"  {points}", style="dim" if look == "passed" else STYLES[look])
    _line(console, head)
    if look == "passed" or outcome.hidden or outcome.finding.observed == told:
        return
    finding = outcome.finding
    if look == "skipped":
        _details(console, [("", finding.observed)])
        return
    where = str(finding.where) if finding.where is not None else ""
    labels = (("seen", finding.observed), ("expected", finding.expected), ("why", finding.cause), ("where", where))
    _details(console, [(label, text) for label, text in labels if text])


def _details(console: Console, rows: list[tuple[str, str]]) -> None:
    if not console.is_terminal or console.width < NARROW:
        for label, text in rows:
            _line(console, Text(f"    {label}: {printable(text)}" if label else f"    {printable(text)}"))
        return
    table = Table.grid(padding=(0, 1))
    table.add_column(width=3)
    if any(label for label, _ in rows):
        table.add_column(min_width=8, style="dim")
    table.add_column(overflow="fold")
    for label, text in rows:
        table.add_row("", *([label] if label else []), Text(printable(text)))
    console.print(table)


def _verdict(report: Report) -> Text:
    meant = tone(report)
    return Text(verdict(report), style="bold green" if meant == "passed" else STYLES[meant])


def _footnotes(report: Report, *, verbose: bool) -> list[str]:
    clock = {"simulated": "Judged in simulated time", "wall": "Judged in wall time"}.get(report.clock, "")
    why = printable(report.clock_why)
    # Simulated time judges nearly all nodes: told where somebody wants to know, or where it was not so.
    simulated_alone = report.clock == "simulated" and "in wall time: " not in why
    notes = [] if simulated_alone and not verbose else [f"{clock}: {why}" if clock and why else clock or why]
    if report.seed is not None:
        notes.append(f"The turtle's start was drawn with seed {report.seed}.")
    if not report.confined:
        notes.append(UNCONFINED)
    if report.recording is not None:
        notes.append(f"Recording: {printable(report.recording)}")
    return [note for note in notes if note]


def _points(points: float) -> str:
    return f"{points:g}"


def _line(console: Console, text: Text) -> None:
    """One line; piped, it is not wrapped."""
    console.print(text, soft_wrap=not console.is_terminal, highlight=False, markup=False)

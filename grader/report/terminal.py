"""Print a report to the terminal: one line per check with details below it, and the verdict at the end.

On a terminal, the report has colours and a hanging indent. In a pipe, it has the same words, with each entry on one
line. All text from a student is printed as plain text, without markup or control characters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.text import Text

from grader.checks.outcome import Outcome, Status
from grader.common.standard_streams import has_signs
from grader.common.words import count, printable
from grader.report.certainty import cause_label
from grader.report.verdict import sandbox_note, tone, verdict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from grader.evidence.tries import Tries
    from grader.report.report import Report

RESULTS = {
    "passes": "the check then passes",
    "further": "the node gets further",
    "refuted": "the check still does not pass",
}
HIDDEN = "This check is hidden, so the report shows no details."
SAME = "The reason is the same as for the previous check."
NARROW = 50
"""On a terminal with fewer columns than this, text is not indented under its label."""

SIGNS = {"passed": "✓", "failed": "✗", "skipped": "-", "error": "!", "advice": "i"}
ASCII_SIGNS = {"passed": "ok", "failed": "FAIL", "skipped": "skip", "error": "ERROR", "advice": "note"}
STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "error": "bold magenta", "advice": "cyan"}


def render(report: Report, console: Console, *, brief: bool = False, verbose: bool = False) -> None:
    """Print the report.

    With `brief`, checks that passed or were skipped are not printed. With `verbose`, the clock is always printed.
    """
    _line(console, Text(printable(f"{report.exercise_title}: {report.submission}"), style="bold"))
    shown = ""
    for outcome in report.outcomes:
        if not (brief and _look(outcome) in ("passed", "skipped")):
            _check(outcome, console, shown)
        shown = "" if outcome.hidden else outcome.finding.observed
    console.print()
    if brief:
        amount = count(len(report.with_status(Status.PASSED)), "check")
        _line(
            console,
            Text(f"{amount} passed. To see all checks, run `grader check` or make the window taller.", style="dim"),
        )
    _line(console, _verdict(report))
    for text in _footnotes(report, verbose=verbose):
        _line(console, Text(text, style="dim"))


def render_changes(before: Report, after: Report, console: Console) -> None:
    """Print the checks whose findings differ in two reports on the same submission."""
    known = {outcome.id: outcome.finding for outcome in before.outcomes}
    for outcome in after.outcomes:
        if outcome.finding != known.get(outcome.id):
            _check(outcome, console, "")


def early(outcomes: Sequence[Outcome]) -> list[str]:
    """Return one line for each check that is not hidden and whose failure is certain before the build.

    Users see these lines first.
    """
    shown = [(outcome, outcome.finding) for outcome in outcomes if not outcome.hidden]
    lines = [
        f"{outcome.title}: {finding.observed}" + (f" ({finding.where})" if finding.where else "")
        for outcome, finding in shown
    ]
    return [printable(f"Already wrong in the files: {line}") for line in lines]


def changes(tries: Tries, console: Console) -> None:
    """Print the changes that were made in copies of the submission to test supposed causes.

    These changes are parts of solutions, so students should not see them.
    """
    if tries.made or tries.stopped:
        console.print()
    for each in tries.made:
        _line(console, Text(f"Tested for {each.check} ({each.diagnosis}): {RESULTS[each.result]}", style="bold"))
        for line in each.difference.splitlines():
            _line(console, Text(f"    {printable(line)}"))
    if tries.stopped:
        _line(console, Text(f"Not all causes were tested: {tries.stopped}.", style="dim"))


def _look(outcome: Outcome) -> str:
    """Return the status of the outcome, or "advice" for advice that was not followed."""
    if outcome.advice and outcome.status is Status.FAILED:
        return "advice"
    return outcome.status.value


def _check(outcome: Outcome, console: Console, shown: str) -> None:
    """Print one check. `shown` is the message of the previous check.

    If the message of this check is the same, it is not repeated, and a failed check refers to the previous one.
    """
    look = _look(outcome)
    signs = SIGNS if has_signs(console.encoding) else ASCII_SIGNS
    head = Text(f"{signs[look]} ", style=STYLES[look])
    head.append(printable(outcome.title), style="" if look == "passed" else "bold")
    if outcome.max:
        points = f"{_points(outcome.points)}/{_points(outcome.max)}" + (" so far" if look == "error" else "")
        head.append(f"  {points}", style="dim" if look == "passed" else STYLES[look])
    _line(console, head)
    if look != "passed" and outcome.hidden:
        _details(console, [("", HIDDEN)])
        return
    if look == "passed" or outcome.finding.observed == shown:
        if look == "failed":
            _details(console, [("", SAME)])
        return
    finding = outcome.finding
    if look == "skipped":
        _details(console, [("", finding.observed)])
        return
    where = str(finding.where) if finding.where is not None else ""
    labels = (
        ("seen", finding.observed),
        ("expected", finding.expected),
        (cause_label(outcome), finding.cause),
        ("where", where),
        ("tried", finding.tried),
    )
    _details(console, [(label, text) for label, text in labels if text])


def _details(console: Console, rows: list[tuple[str, str]]) -> None:
    if not console.is_terminal or console.width < NARROW:
        for label, text in rows:
            _line(console, Text(f"    {label}: {printable(text)}" if label else f"    {printable(text)}"))
        return
    from rich.table import Table  # takes 6 ms, and a report without details needs no table

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
    # Nearly all nodes are judged in simulated time only, so this is printed only on request.
    simulated_alone = report.clock == "simulated" and "in wall time: " not in why
    notes = [] if simulated_alone and not verbose else [f"{clock}: {why}" if clock and why else clock or why]
    if report.seed is not None:
        notes.append(f"The random inputs of the trials were generated with seed {report.seed}.")
    notes.append(sandbox_note(report))
    if report.recording is not None:
        notes.append(f"Recording: {printable(report.recording)}")
    return [note for note in notes if note]


def _points(points: float) -> str:
    return f"{points:g}"


def _line(console: Console, text: Text) -> None:
    """Print one line, which is not wrapped if the output goes to a pipe."""
    console.print(text, soft_wrap=not console.is_terminal, highlight=False, markup=False)

"""Grade the work next to a notebook, in a separate process that the notebook's cells cannot change.

    python -m grader.notebook.grading_process EXERCISE FOLDER

The process prints its progress line by line to standard error, and the verdict as JSON to standard output: {"points":
{id: number}, "reasons": {id: text}, "text": the full verdict, "html": the same as HTML, "passed": bool}. If the work
cannot be graded, the JSON is {"error": text}.
"""

from __future__ import annotations

import io
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.checks.judge import in_words
from grader.checks.outcome import Status
from grader.common.system_errors import refusal
from grader.errors import GraderError, MachineError
from grader.grading.grade import Graded, grade
from grader.grading.options import Options
from grader.notebook.mode import confined
from grader.report.certainty import cause_label
from grader.report.plain import plain_line
from grader.sandbox import bubblewrap
from grader.submission.package import open_answers, open_submission

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome
    from grader.exercise.model import Exercise
    from grader.submission.package import Submission


def opened(exercise: Exercise, folder: Path) -> Submission:
    """Open the submission next to the notebook in `folder`. Raises UsageError if there is no submission."""
    if not exercise.package:
        return open_answers(folder)
    own = folder / exercise.package
    return open_submission(own if own.is_dir() else folder)


def reason(outcome: Outcome) -> str:
    """Return the outcome of a check as plain text: its status, title and points, and the reason if it did not pass.

    The title and the reason of a hidden check are left out.
    """
    sign = {Status.PASSED: "✓", Status.FAILED: "✗", Status.SKIPPED: "-", Status.ERROR: "!"}[outcome.status]
    points = f"  {outcome.points:g}/{outcome.max:g}" if outcome.max else ""
    if outcome.hidden:
        return f"{sign} Hidden check{points}"
    finding = outcome.finding
    lines = [f"{sign} {outcome.title}{points}"]
    if outcome.status is not Status.PASSED:
        where = str(finding.where) if finding.where else ""
        rows = (
            ("seen", finding.observed),
            ("expected", finding.expected),
            (cause_label(outcome), finding.cause),
            ("where", where),
        )
        lines += [f"    {label}: {text}" for label, text in rows if text]
    return "\n".join(map(plain_line, lines))


def to_data(graded: Graded, *, html: bool) -> dict[str, object]:
    """Return the verdict as a dictionary that JSON can represent."""
    from rich.console import Console

    from grader.report import terminal

    # If the kernel is in a cell, its children are in the same cell.
    report = replace(graded.report, confined=graded.report.confined or confined())
    page = io.StringIO()
    terminal.render(report, Console(file=page, width=100, highlight=False, force_terminal=False, color_system=None))
    shown = ""
    if html:
        from grader.report.html_notebook import html_fragment

        shown = html_fragment(graded.evidence, report)
    return {
        "points": {outcome.id: outcome.points for outcome in report.outcomes},
        "reasons": {outcome.id: reason(outcome) for outcome in report.outcomes},
        "text": page.getvalue(),
        "html": shown,
        "passed": report.exit_code == 0,
    }


def main() -> int:
    """Grade the submission, and print the verdict."""
    name, folder = sys.argv[1:]
    try:
        exercise = find_exercise(name)
        submission = opened(exercise, Path(folder))
        options = Options(in_cell=not confined() and bubblewrap.usable())
        graded = grade(exercise, submission, options, lambda text: print(text, file=sys.stderr, flush=True))
    except GraderError as error:
        json.dump({"error": str(error)}, sys.stdout)
        return error.exit_code
    except Exception as error:
        json.dump({"error": refusal(error) or in_words(error)}, sys.stdout)
        return MachineError.exit_code
    json.dump(to_data(graded, html=True), sys.stdout, allow_nan=False)
    return 0


if __name__ == "__main__":
    sys.exit(main())

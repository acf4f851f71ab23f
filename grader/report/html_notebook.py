"""The verdict as HTML for the output of a notebook cell: a table with reasons, and then the drawings of each run.

The HTML has no script, and its style sheet affects nothing else on the page. Every id contains a key of the
submission, because one notebook can show the verdicts of many submissions.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.errors import UnreadableError
from grader.report.escaped_template import compiled, fill
from grader.report.html import ShownCheck, without_content
from grader.report.html_run import runs_of
from grader.report.verdict import sandbox_note, tone, verdict
from grader.submission.reader import read

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.report.report import Report


TEMPLATE = "notebook.html"


def html_fragment(evidence: Evidence, report: Report) -> str:
    """Return the verdict as HTML, without drawings if the output of the submission cannot be drawn."""
    compiled(TEMPLATE)
    try:
        return read(_fragment, evidence, report)
    except UnreadableError:
        return _fragment(without_content(evidence), report)


def _fragment(evidence: Evidence, report: Report) -> str:
    worth = [o for o in report.outcomes if o.max or o.status is not Status.PASSED]
    values = {
        "report": report,
        "sandbox_note": sandbox_note(report),
        "verdict": verdict(report),
        "tone": tone(report),
        "checks": [ShownCheck(number, outcome) for number, outcome in enumerate(worth, 1)],
        "silent": len(report.outcomes) - len(worth),
        "runs": runs_of(evidence.views(), _key(report)),
    }
    return fill(TEMPLATE, values)


def _key(report: Report) -> str:
    return "n" + hashlib.sha256(f"{report.exercise} {report.digest}".encode()).hexdigest()[:8]

"""The verdict as a piece of HTML for a notebook's cell: the table with reasons, then what was seen of each run.

No script, and a style sheet that touches nothing but this piece. Every id in it begins with a key of its own, since a
notebook shows many pieces on one page.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.errors import UnreadableError
from grader.report.html import ShownCheck, without_content
from grader.report.html_run import runs_of
from grader.report.template import fill
from grader.report.verdict import UNCONFINED, tone, verdict
from grader.submission.reader import read

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.report.report import Report


def html_fragment(evidence: Evidence, report: Report) -> str:
    """The piece of HTML; without drawings where what the submission has made cannot be drawn."""
    try:
        return read(_fragment, evidence, report)
    except UnreadableError:
        return _fragment(without_content(evidence), report)


def _fragment(evidence: Evidence, report: Report) -> str:
    worth = [o for o in report.outcomes if o.max or o.status is not Status.PASSED]
    values = {
        "report": report,
        "unconfined": UNCONFINED,
        "verdict": verdict(report),
        "tone": tone(report),
        "checks": [ShownCheck(number, outcome) for number, outcome in enumerate(worth, 1)],
        "silent": len(report.outcomes) - len(worth),
        "runs": runs_of(evidence.views(), _key(report)),
    }
    return fill("notebook.html", values)


def _key(report: Report) -> str:
    return "n" + hashlib.sha256(f"{report.exercise} {report.digest}".encode()).hexdigest()[:8]

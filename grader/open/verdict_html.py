"""The details of a verdict as HTML for the page: failed checks, errors, advice, and the trajectory with its player."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import quote

from grader.errors import UnreadableError
from grader.report.escaped_template import compiled, fill
from grader.report.expectations import must_drive
from grader.report.html import shown_checks, without_content
from grader.report.html_page import script_json
from grader.report.html_run import runs_of
from grader.report.scene import scene_of
from grader.submission.reader import read

if TYPE_CHECKING:
    from pathlib import Path

    from grader.evidence.evidence import Evidence
    from grader.report.report import Report
    from grader.submission.where import Where

TEMPLATE = "verdict.html"


def verdict_html(evidence: Evidence, report: Report, folder: Path) -> str:
    """Return the HTML. `folder` is the folder of the package. The links open the package's files in VS Code.

    If the submission or the recorded data cannot be shown, the HTML has no code and no drawings.
    """
    compiled(TEMPLATE)
    try:
        return read(_html, evidence, report, folder)
    except UnreadableError:
        return _html(without_content(evidence), report, folder)


def _html(evidence: Evidence, report: Report, folder: Path) -> str:
    def opens(where: Where) -> str:
        """Return the URL that opens the place in VS Code, or an empty string for a path outside the folder."""
        file = folder / where.file
        if not file.resolve().is_relative_to(folder.resolve()):
            return ""
        return f"vscode://file{quote(str(file))}" + (f":{where.line}" if where.line else "")

    checks = shown_checks(evidence, report)
    # Without a package, the simulator ran only to check answers.
    runs = runs_of([view for view in evidence.views() if _is_worth_showing(view)]) if evidence.exercise.package else []
    fault = evidence.fault.message if evidence.fault and not evidence.fault.unreadable else ""
    values = {
        "to_fix": [each for each in checks if each.kind in ("failed", "error", "advice")],
        "runs": runs,
        "fault": fault,
        "opens": opens,
        "data": script_json([run.data for run in runs]),
    }
    return fill(TEMPLATE, values)


def _is_worth_showing(view: Evidence) -> bool:
    """Return whether the turtle had to drive or has moved.

    A picture of a turtle that correctly stands still would only confuse the learner.
    """
    return must_drive(view) or (view.run.recording is not None and not scene_of(view).notice)

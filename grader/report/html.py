"""The page of one submission: the verdict, the checks with the code that they refer to, the replay, graph and logs.

The page omits everything that differs from run to run (wall times and paths of recordings), so a page that is generated
again from a recording is identical.
"""

from __future__ import annotations

import shlex
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.errors import UnreadableError
from grader.report.certainty import is_certain
from grader.report.code_excerpt import excerpt
from grader.report.escaped_template import compiled
from grader.report.html_page import make_page, save_page
from grader.report.html_run import runs_of
from grader.report.logs import logs_of
from grader.report.plain import plain_line
from grader.report.verdict import sandbox_note, tone, verdict
from grader.submission.reader import read

if TYPE_CHECKING:
    from pathlib import Path

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.report.code_excerpt import Excerpt
    from grader.report.report import Report
    from grader.submission.where import Where

TEMPLATE = "report.html"
CODE_BYTES = 50_000
"""The maximum size of all code excerpts together. Once this total is reached, later checks show only the file and the
line."""


@dataclass(frozen=True)
class ShownCheck:
    """A check as the page shows it. `above` is the number of an earlier check that shows the same line of code."""

    number: int
    outcome: Outcome
    code: Excerpt | None = None
    above: int | None = None

    @property
    def title(self) -> str:
        """The title of the check. The title of a hidden check does not reveal what is checked."""
        return "Hidden check" if self.outcome.hidden else self.outcome.title

    @property
    def observed(self) -> str:
        """The observation. The text is empty if the check is hidden, or if the text would only repeat the title."""
        text = self.outcome.finding.observed
        return "" if self.outcome.hidden or text.rstrip(".") == self.outcome.title else text

    @property
    def certain(self) -> bool:
        """Whether the cause is a fact."""
        return is_certain(self.outcome)

    def shows(self, where: Where) -> bool:
        """Return whether the code shown with this check includes the line `where`."""
        code = self.code
        return code is not None and code.file == where.file and any(line.number == where.line for line in code.lines)

    @property
    def kind(self) -> str:
        """The result of the check: passed, failed, skipped, error, or advice that was not followed."""
        if self.outcome.advice and self.outcome.status is Status.FAILED:
            return "advice"
        return self.outcome.status.value


def save_html(evidence: Evidence, report: Report, file: Path) -> None:
    """Write the page. Raises the same errors as `output_file.write`."""
    save_page(html_page(evidence, report), file)


def html_page(evidence: Evidence, report: Report) -> str:
    """Return the page as a string.

    If the output of a submission cannot be drawn, the page contains verdict and checks, but no code, drawings or logs.
    """
    compiled(TEMPLATE)
    try:
        return read(_page, evidence, report)
    except UnreadableError:
        return _page(without_content(evidence), report)


def without_content(evidence: Evidence) -> Evidence:
    """Return the evidence without the files of the submission, its build and its trials."""
    nothing = replace(evidence.submission, files={}, rejected=(), executable=frozenset())
    return replace(evidence, submission=nothing, build=None, runs={})


def _page(evidence: Evidence, report: Report) -> str:
    evidences = evidence.views()
    runs = runs_of(evidences)
    shown = shown_checks(evidence, report)
    fault = evidence.fault.message if evidence.fault and not evidence.fault.unreadable else ""
    # Show a machine fault only once, instead of with every check that could not be judged because of it.
    unmade = [check for check in shown if check.kind == "error" and check.outcome.finding.observed == fault]
    values = {
        "report": report,
        "sandbox_note": sandbox_note(report),
        "verdict": verdict(report),
        "tone": tone(report),
        "to_fix": [each for each in shown if each.kind in ("failed", "error", "advice") and each not in unmade],
        "unmade": unmade,
        "skipped": [check for check in shown if check.kind == "skipped"],
        "passed": [check for check in shown if check.kind == "passed"],
        "runs": runs,
        # A report that names a clock is about a recording, even if that recording cannot be drawn.
        "drawn_nothing": not runs and (report.clock != "none" or any(view.run.made for view in evidences)),
        "drawn": [run for run in runs if run.graph],
        "logs": logs_of(evidences),
        "again": _again(report),
        "fault": fault,
    }
    return make_page(TEMPLATE, ("player.js", "report.js"), [run.data for run in runs], values)


def shown_checks(evidence: Evidence, report: Report) -> list[ShownCheck]:
    """Return all checks for a page. A check shows no code if an earlier check already shows its line."""
    shown: list[ShownCheck] = []
    room = CODE_BYTES
    for number, outcome in enumerate(report.outcomes, 1):
        where = None if outcome.hidden or outcome.status is not Status.FAILED else outcome.finding.where
        above = None if where is None else next((each.number for each in shown if each.shows(where)), None)
        code = None if above else excerpt(evidence, where)
        room -= code.size if code else 0
        if room < 0:
            code = None
        shown.append(ShownCheck(number, outcome, code, above))
    return shown


def _again(report: Report) -> str:
    """Return the command that grades the submission again."""
    command = ["grader", "check", report.submission, "--exercise", report.exercise]
    if report.seed is not None:
        command += ["--seed", str(report.seed)]
    return plain_line(shlex.join(command))

"""Reports for tests: a report for each status, and a hostile report.

The grader judges invented evidence to create all these reports.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.judge import judge
from grader.checks.outcome import Finding, Status
from grader.evidence.evidence import Fault
from grader.report.report import Report
from grader.submission.where import Where
from grader.tests.checks.made import BUILD, evidence, exercise, good
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.hostile import ALL, ODD

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

STATUSES = ("passed", "failed", "skipped", "error")
FORMULA = '=HYPERLINK("http://evil.example","click")'
INJECTED = "\r\n::error title=owned::owned\n##[error]owned\n::set-output name=x::y"
MARKDOWN = "![x](http://evil.example/x.png) [y](javascript:alert(1)) <img src=x onerror=alert(1)> `a` | b | @octocat #1"
HOSTILE = f"{FORMULA} {INJECTED} {MARKDOWN} {ALL} {ODD}"
"""Formulas, workflow commands, Markdown, HTML and odd characters."""

NOT_BUILT = replace(BUILD, exit_code=1, log="error: no such option", executables=(), entry_points={}, installed=())

EVIDENCE: dict[str, Evidence] = {
    "passed": evidence(good()),
    "failed": evidence(SHAPES["radius 2.2"]()),
    "skipped": evidence(None, build=NOT_BUILT),
    "error": evidence(None, build=None, fault=Fault("build", "The disk is full: make room, then grade again.")),
}


def report_of(given: Evidence, **changes: object) -> Report:
    trial = given.run.recording
    made = Report(
        exercise=given.exercise.id,
        exercise_title=given.exercise.title,
        submission="alice/my_robot_controller",
        digest="5" * 64,
        grader="0.1.0",
        ros="jazzy",
        clock=trial.clock if trial else "none",
        clock_why="The node waits only for ROS time." if trial else "The node was not run.",
        seed=None,
        outcomes=judge(given),
        seconds={"build": 1.5},
        exercise_digest="e" * 64,
    )
    return replace(made, **changes)  # type: ignore[arg-type]


def report(status: str, **changes: object) -> Report:
    """Return a report in which this status occurs. The report contains the checks of step 03."""
    assert exercise().checks
    return report_of(EVIDENCE[status], **changes)


def hostile_report(status: str = "failed") -> Report:
    """Return a report in which every text that a student can choose is an attack."""
    made = report(status, submission=HOSTILE)
    finding = Finding(Status.FAILED, HOSTILE, HOSTILE, HOSTILE, "a-diagnosis", Where(HOSTILE, 3))
    return replace(made, outcomes=tuple(replace(outcome, finding=finding) for outcome in made.outcomes))

"""One report a status, made by the judge from evidence made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.judge import judge
from grader.evidence.evidence import Fault
from grader.report.report import Report
from grader.tests.checks.made import BUILD, evidence, exercise, good
from grader.tests.checks.shapes import SHAPES

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

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
    """The report with this status in it; the exercise's checks are those of the course."""
    assert exercise().checks
    return report_of(EVIDENCE[status], **changes)

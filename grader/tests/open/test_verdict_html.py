"""The details of a verdict in the page."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from grader.checks.exercises import find_exercise
from grader.open.verdict_html import verdict_html
from grader.tests.checks.made import evidence
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.reports import report_of

RUN = "What the turtle did"


@pytest.mark.parametrize(
    ("step", "shape", "shown"),
    [
        ("01-first-node", "no messages", False),
        ("01-first-node", "good", True),
        ("03-circle-publisher", "no messages", True),
    ],
)
def test_a_turtle_that_rightly_stands_still_is_not_shown(step: str, shape: str, *, shown: bool) -> None:
    given, exercise = evidence(SHAPES[shape]()), find_exercise(step)
    (run,) = given.runs.values()
    given = replace(given, exercise=exercise, runs={exercise.trials[0].id: run})
    assert (RUN in verdict_html(given, report_of(given), Path("/"))) == shown

"""In every format, the points of a check that could not be judged still count toward the maximum."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.outcome import Finding, Status
from grader.report.class_reports import Entry
from grader.report.github import to_summary
from grader.report.junit import to_junit
from grader.tests.report.readers import gradescope, shown, table
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from grader.report.report import Report


def unfinished() -> Report:
    """Return a report with 75 points in which the circle could not be judged and all other checks passed."""
    made = report("passed")
    broken = Finding(Status.ERROR, "The machine was too busy.")
    outcomes = (replace(each, points=0.0, finding=broken) if each.id == "circle" else each for each in made.outcomes)
    return replace(made, outcomes=tuple(outcomes))


def test_an_error_does_not_lower_the_maximum() -> None:
    given = unfinished()
    (row,) = table(("anna", given))
    assert (row["points"], row["max"], row["percent"], row["status"]) == ("75", "100", "75.0", "error")
    properties = ET.fromstring(to_junit([("anna", given)])).iter("property")
    assert {each.get("name"): each.get("value") for each in properties}.items() >= {
        "points": "75",
        "max": "100",
    }.items()
    data = gradescope(given)
    circle = next(test for test in data["tests"] if test["name"] == "The turtle drives a circle")
    assert (data["score"], circle["score"], circle["max_score"], circle["status"]) == (75, 0, 25, "failed")
    assert "75 of 100" in shown(to_summary([("anna", given)])).cells
    assert "0/25" in shown(to_summary([("anna", given)])).cells
    assert Entry(given, "anna", "").share == 0.75

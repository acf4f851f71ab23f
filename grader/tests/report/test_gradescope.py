"""A report as Gradescope's results.json."""

from __future__ import annotations

import pytest

from grader.tests.report.readers import gradescope
from grader.tests.report.reports import STATUSES, hostile_report, report


@pytest.mark.parametrize("status", STATUSES)
def test_gradescope_gets_only_keys_of_its_specification(status: str) -> None:
    given = report(status)
    data = gradescope(given)
    assert data["score"] == pytest.approx(given.points)
    assert sum(test.get("score", 0) for test in data["tests"]) == pytest.approx(given.points)
    assert sum(test.get("max_score", 0) for test in data["tests"]) == pytest.approx(given.max)
    assert [test["name"] for test in data["tests"]] == [outcome.title for outcome in given.outcomes]


def test_hostile_text_is_shown_as_plain_text() -> None:
    data = gradescope(hostile_report())
    assert {test["output_format"] for test in data["tests"]} == {data["output_format"]} == {"text"}
    assert all(line.isprintable() for test in data["tests"] for line in test["output"].split("\n"))

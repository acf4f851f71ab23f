"""The tables of service calls and goals in a page."""

from __future__ import annotations

import pytest

from grader.report.html import html_page
from grader.tests.checks.made import evidence, recording
from grader.tests.report.reports import report_of
from grader.trial.observed import Call


@pytest.mark.parametrize(("amount", "said"), [(2, "2"), (101, "the first 100 of 101")])
def test_a_table_of_calls_says_how_many_calls_it_leaves_out(amount: int, said: str) -> None:
    calls = tuple(Call(float(number), "/spawn", "turtlesim/srv/Spawn", {}) for number in range(amount))
    given = evidence(recording([], calls=calls))
    assert f"The service calls: {said}<" in html_page(given, report_of(given, submission=given.submission.name))

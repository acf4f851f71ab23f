"""For every failure in the list of this module, the message uses words that a beginner understands."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import pytest

from grader.checks.judge import judge
from grader.checks.outcome import Finding, Status
from grader.tests.checks.made import BUILD, NODE_FILE, SETUP_PY, evidence, good, node, submission
from grader.tests.checks.shapes import SHAPES

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.evidence.evidence import Evidence

MOST_WORDS = 60
SOLUTION = (
    "linear.x = 2.0",
    "angular.z = 1.0",
    "create_timer(0.5",
    'create_publisher(Twist, "/turtle1/cmd_vel"',
    "publish(msg)",
)
"""Lines of the solution. No message may contain one of them."""


NOT_INSTALLED = replace(BUILD, executables=(), entry_points={}, installed=())
GIVEN: dict[str, Callable[[], Evidence]] = {
    **{name: lambda make=make: evidence(make()) for name, make in SHAPES.items()},  # type: ignore[misc]
    "no setup.py": lambda: evidence(None, submission({"setup.py": None}), NOT_INSTALLED),
    "no package.xml": lambda: evidence(good(), submission({"package.xml": None})),
    "broken package.xml": lambda: evidence(good(), submission({"package.xml": "<package>"})),
    "syntax error": lambda: evidence(None, submission({NODE_FILE: "def main(:\n"})),
    "no entry point": lambda: evidence(
        None, submission({"setup.py": SETUP_PY.replace("draw_circle = ", "x = ")}), NOT_INSTALLED
    ),
    "no init": lambda: evidence(
        None, submission({"my_robot_controller/__init__.py": None}), replace(NOT_INSTALLED, executables=("x",))
    ),
    "milliseconds": lambda: evidence(SHAPES["no messages"](), node(("create_timer(0.5", "create_timer(500"))),
    "long names": lambda: evidence(
        SHAPES["no messages"](), submission({"setup.py": SETUP_PY.replace("my_robot", "x" * 900)})
    ),
}
"""Submissions for tests of the messages. Most of these submissions fail. Such a submission is made when a test needs
it, not when pytest collects the tests."""
ALL_RIGHT = ["good", "good elsewhere", "more after Ctrl-C"]
"""The submissions that pass every check."""


@cache
def failures(name: str) -> dict[str, Finding]:
    return {outcome.id: outcome.finding for outcome in judge(GIVEN[name]()) if outcome.status is Status.FAILED}


def test_all_other_submissions_fail() -> None:
    assert [name for name in GIVEN if not failures(name)] == ALL_RIGHT


@pytest.mark.parametrize("name", GIVEN)
def test_a_failure_says_what_was_observed_and_expected_in_few_words(name: str) -> None:
    for finding in failures(name).values():
        assert finding.diagnosis
        assert finding.observed.endswith(".")
        assert finding.expected.endswith(".")
        assert not finding.cause or finding.cause.endswith((".", "?"))
        parts = (finding.observed, finding.expected, finding.cause, str(finding.where or ""))
        text = " ".join(part for part in parts if part)
        assert len(text.split()) <= MOST_WORDS, text
        assert len(text) <= 600
        assert "  " not in text


@pytest.mark.parametrize("name", GIVEN)
def test_no_failure_tells_a_line_of_the_solution(name: str) -> None:
    for finding in failures(name).values():
        text = f"{finding.observed} {finding.expected} {finding.cause}".replace("'", '"')
        assert [line for line in SOLUTION if line in text] == []


@pytest.mark.parametrize("name", SHAPES)
def test_a_cause_holds_no_time_that_differs_from_run_to_run(name: str) -> None:
    """Reports on one submission are compared by their causes (docs/design.md, decision 12)."""
    later = SHAPES[name]()
    moved = replace(
        later,
        commands=tuple(replace(each, t_s=each.t_s + 0.013) for each in later.commands),
        end=replace(later.end, t_s=later.end.t_s + (0.013 if later.end.t_s > 0.0 else -0.013)),
    )
    again = {outcome.id: outcome.finding for outcome in judge(evidence(moved))}
    for id_, finding in failures(name).items():
        assert (again[id_].cause, again[id_].diagnosis) == (finding.cause, finding.diagnosis)

"""Every failure in the list below has a message with words that a beginner understands."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.judge import judge
from grader.checks.outcome import Outcome, Status
from grader.tests.checks.made import BUILD, NODE_FILE, SETUP_PY, evidence, good, node, submission
from grader.tests.checks.shapes import SHAPES

MOST_WORDS = 60
SOLUTION = (
    "linear.x = 2.0",
    "angular.z = 1.0",
    "create_timer(0.5",
    'create_publisher(Twist, "/turtle1/cmd_vel"',
    "publish(msg)",
)
"""Lines of the solution. No message may contain one of them."""


def catalogue() -> dict[str, Outcome]:
    given = {name: evidence(make()) for name, make in SHAPES.items()}
    none = replace(BUILD, executables=(), entry_points={}, installed=())
    given["no setup.py"] = evidence(None, submission({"setup.py": None}), none)
    given["no package.xml"] = evidence(good(), submission({"package.xml": None}))
    given["broken package.xml"] = evidence(good(), submission({"package.xml": "<package>"}))
    given["syntax error"] = evidence(None, submission({NODE_FILE: "def main(:\n"}))
    given["no entry point"] = evidence(None, submission({"setup.py": SETUP_PY.replace("draw_circle = ", "x = ")}), none)
    given["no init"] = evidence(
        None, submission({"my_robot_controller/__init__.py": None}), replace(none, executables=("x",))
    )
    given["milliseconds"] = evidence(SHAPES["no messages"](), node(("create_timer(0.5", "create_timer(500")))
    given["long names"] = evidence(
        SHAPES["no messages"](), submission({"setup.py": SETUP_PY.replace("my_robot", "x" * 900)})
    )
    return {
        f"{name}: {outcome.id}": outcome
        for name, each in given.items()
        for outcome in judge(each)
        if outcome.status is Status.FAILED
    }


FAILURES = catalogue()


@pytest.mark.parametrize("name", sorted(FAILURES))
def test_a_failure_says_what_was_observed_and_expected_in_few_words(name: str) -> None:
    finding = FAILURES[name].finding
    assert finding.diagnosis
    assert finding.observed.endswith(".")
    assert finding.expected.endswith(".")
    assert not finding.cause or finding.cause.endswith((".", "?"))
    parts = (finding.observed, finding.expected, finding.cause, str(finding.where or ""))
    text = " ".join(part for part in parts if part)
    assert len(text.split()) <= MOST_WORDS, text
    assert len(text) <= 600
    assert "  " not in text


@pytest.mark.parametrize("name", sorted(FAILURES))
def test_no_failure_tells_a_line_of_the_solution(name: str) -> None:
    finding = FAILURES[name].finding
    text = f"{finding.observed} {finding.expected} {finding.cause}".replace("'", '"')
    assert [line for line in SOLUTION if line in text] == []


@pytest.mark.parametrize("name", sorted(FAILURES))
def test_a_cause_holds_no_time_that_differs_from_run_to_run(name: str) -> None:
    """Reports on one submission are compared by their causes (docs/design.md, decision 12)."""
    shape, _, id_ = name.partition(": ")
    if shape not in SHAPES:
        return
    later = SHAPES[shape]()
    moved = replace(
        later,
        commands=tuple(replace(each, t_s=each.t_s + 0.013) for each in later.commands),
        end=replace(later.end, t_s=later.end.t_s + (0.013 if later.end.t_s > 0.0 else -0.013)),
    )
    again = {outcome.id: outcome for outcome in judge(evidence(moved))}[id_].finding
    assert (again.cause, again.diagnosis) == (FAILURES[name].finding.cause, FAILURES[name].finding.diagnosis)

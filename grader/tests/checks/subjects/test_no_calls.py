"""Doing without certain functions, where that is the task; advice."""

from __future__ import annotations

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.advice import USES_TIMER
from grader.checks.subjects.no_calls import NO_CALLS
from grader.tests.checks.made import NODE, NODE_FILE, evidence, found, submission

NAMES = ("teleport", "create_client")


@pytest.mark.parametrize(
    ("last", "seen"),
    [
        ("node.create_client(x)", "The node calls create_client."),
        ("create_client(x)", "The node calls teleport."),
        ("turtles.teleport(1)\nnode.create_client(x)", "The node calls teleport."),
    ],
)
def test_a_forbidden_call_is_shown_where_it_stands(last: str, seen: str) -> None:
    given = evidence(package=submission({NODE_FILE: f"{NODE}\n{last}\n"}))
    finding = found(NO_CALLS, given, names=NAMES, cause="Drive there.")
    assert (finding.diagnosis, finding.seen, str(finding.where)) == ("forbidden-call", seen, f"{NODE_FILE}:23")


def test_what_other_files_call_is_not_the_nodes() -> None:
    helper = {
        NODE_FILE: f"from my_robot_controller import helper\n{NODE}",
        "my_robot_controller/helper.py": "teleport(1)\n",
    }
    given = evidence(package=submission(helper))
    assert found(NO_CALLS, given, names=NAMES, cause="Drive there.").status is Status.PASSED


def test_a_node_without_a_timer_is_shown_what_takes_its_place() -> None:
    loops = NODE.replace("self.create_timer(0.5, self.send)", "None")
    finding = found(USES_TIMER, evidence(package=submission({NODE_FILE: loops})))
    assert (finding.diagnosis, str(finding.where)) == ("no-timer", f"{NODE_FILE}:16")
    assert "receives no messages" in finding.cause


def test_whoever_has_a_rate_is_not_told_that_the_node_hears_nothing() -> None:
    rate = NODE.replace("self.create_timer(0.5, self.send)", "self.create_rate(2)")
    finding = found(USES_TIMER, evidence(package=submission({NODE_FILE: rate})))
    assert finding.diagnosis == "no-timer"
    assert "create_rate" in finding.cause


@pytest.mark.parametrize(
    ("text", "words"), [(None, "the file of the node is not known yet"), ("def (:\n", "cannot be read")]
)
def test_no_advice_is_given_on_a_file_that_is_not_there_or_cannot_be_read(text: str | None, words: str) -> None:
    package = submission({NODE_FILE: text, "setup.py": "setup()\n"})
    finding = found(USES_TIMER, evidence(package=package, build=None))
    assert finding.status is Status.SKIPPED
    assert words in finding.seen

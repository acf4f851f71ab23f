"""The checks of a student's tests, with made-up results."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise, load_exercise
from grader.checks.judge import judge
from grader.checks.kind import NoParams
from grader.checks.outcome import Status
from grader.checks.subjects.tests_run import CATCHES, FOUND, PASS
from grader.errors import UsageError
from grader.evidence.evidence import Evidence, Run
from grader.evidence.recording_format import load, save
from grader.report.html import html_page
from grader.report.report import report_of
from grader.report.scene import scene_of
from grader.testbench.result import BenchResult, Ended, NodeEvents, NodeRun, run_of
from grader.tests.checks import made
from grader.tests.checks.made import found
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from pathlib import Path

    from grader.checks.outcome import Finding

TESTS = "test/test_wall_guard.py"
GOOD = NodeRun("", 0, collected=3, passed=3)
BAD = NodeRun("", 1, collected=3, test=f"{TESTS}::test_it", outcome="failed", message="assert 9 == 10", line=2)
SOURCE = "def test_it(bench):\n    assert bench.count() == 10\n"


def given(*runs: NodeRun, source: str = SOURCE) -> Evidence:
    evidence = Evidence(find_exercise("12-tests"), made.submission({TESTS: source}))
    return evidence.with_run(Run(bench=BenchResult(runs)))


def passes(*runs: NodeRun) -> Finding:
    return PASS.check(given(*runs), NoParams())


def test_tests_that_pass_each_time_pass() -> None:
    assert passes(GOOD, GOOD, GOOD).status is Status.PASSED


@pytest.mark.parametrize("order", [(GOOD, BAD, GOOD), (BAD, GOOD, GOOD), (BAD, BAD, GOOD)])
def test_tests_that_pass_only_sometimes_are_named(order: tuple[NodeRun, ...]) -> None:
    finding = passes(*order)
    assert (finding.status, finding.diagnosis) == (Status.FAILED, "unsteady-tests")
    assert f"in {order.count(GOOD)} of 3 runs" in finding.observed


def test_a_missing_run_on_the_right_node_does_not_pass() -> None:
    """No further run starts after two runs that hung, so runs on the correct node can be missing."""
    hung = NodeRun("stop", None, over=True)
    assert passes(GOOD, hung, dataclasses.replace(hung, node="rate")).diagnosis == "test-hangs"
    assert passes().diagnosis == "test-hangs"


def test_a_broken_node_that_was_not_run_is_not_caught() -> None:
    check = next(check for check in find_exercise("12-tests").checks if check.id == "stop")
    assert CATCHES.judge(given(GOOD), check.params).diagnosis == "test-hangs"
    assert CATCHES.judge(given(dataclasses.replace(BAD, node="stop")), check.params).status is Status.PASSED
    hung = NodeRun("stop", None, over=True)
    assert CATCHES.judge(given(hung), check.params).diagnosis == "test-hangs"


@pytest.mark.parametrize(
    "report",
    [
        *(b"", b"[]", b"{", b"\xff", b"[" * 60_000),
        *(b'{"cases": 3, "collected": "x"}', b'{"cases": [1, {"outcome": []}], "collected": -1}'),
    ],
)
def test_a_forged_report_is_read_as_far_as_it_can_be(report: bytes) -> None:
    assert run_of(Ended("rate", 1, report=report)).exit_code == 1
    assert run_of(Ended("rate", 1, report=report)).collected == 0


def test_a_report_about_tests_does_not_say_that_the_node_was_not_run() -> None:
    evidence = given(BAD, BAD, BAD)
    report = report_of(evidence, judge(evidence), "none", {})
    assert "There is no recording of a run, so" not in html_page(evidence, report)
    assert scene_of(evidence).notice == "The tests do not need a turtle."
    assert report.clock_why == "Your tests were run 3 times."


def test_a_recording_of_tests_is_judged_again(tmp_path: Path) -> None:
    events = NodeEvents(poses=1, calls=2, commands=2, first_s=0.1, clock_s=0.3, all_calls=2)
    evidence = given(
        GOOD, GOOD, dataclasses.replace(GOOD, events=NodeEvents()), dataclasses.replace(BAD, events=events)
    )
    save(tmp_path / "kept", evidence, "none", ())
    again = load(tmp_path / "kept", load_exercise).evidence
    assert again.bench == evidence.bench
    assert judge(again) == judge(evidence)


def test_a_damaged_recording_of_tests_is_refused(tmp_path: Path) -> None:
    save(tmp_path / "kept", given(GOOD), "none", ())
    file = tmp_path / "kept/trials/tests/tests.json"
    file.write_text(file.read_text("utf-8").replace('"message": ""', '"message": 3'), "utf-8")
    with pytest.raises(UsageError, match="is not a recording from"):
        load(tmp_path / "kept", load_exercise)


def test_tests_that_end_without_a_passed_test_do_not_pass() -> None:
    """pytest can exit with 0 if every test is skipped, or if a test ends the process."""
    skipped = dataclasses.replace(GOOD, passed=0, skipped=3)
    assert "skipped" in passes(*[skipped] * 3).cause
    ended = dataclasses.replace(GOOD, passed=0, collected=0)
    assert (passes(*[ended] * 3).diagnosis, "setup.cfg" in passes(*[ended] * 3).cause) == ("all-skipped", True)


def about_pass(*runs: NodeRun, source: str = SOURCE) -> str:
    return told(PASS.check(given(*runs, source=source), NoParams()))


SKIPPED = dataclasses.replace(GOOD, passed=0, skipped=3)
HUNG = NodeRun("stop", None, over=True)
PARTLY = dataclasses.replace(GOOD, passed=0, skipped=1)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("All tests pass on the correct node (3 runs).", [GOOD] * 3, [BAD, GOOD, GOOD]),
        ("All tests pass on the correct node in every run.", [BAD] * 3, [GOOD] * 3),
        ("test_it fails on the correct node: assert 9 == 10.", [BAD] * 3, [GOOD] * 3),
        ("test_it fails on the correct node.", [dataclasses.replace(BAD, message="")] * 3, [BAD] * 3),
        ("The tests pass on the correct node in 2 of 3 runs.", [BAD, GOOD, GOOD], [BAD] * 3),
        ("The tests depend on timing, on random numbers, or on the state", [BAD, GOOD, GOOD], [BAD] * 3),
        ("No test ran to completion.", [SKIPPED] * 3, [GOOD] * 3),
        ("Every test is skipped, and a skipped test tests nothing.", [SKIPPED] * 3, [PARTLY] * 3),
        ("Options in setup.cfg or pytest.ini can exclude tests, and a test can end", [PARTLY] * 3, [SKIPPED] * 3),
        ("The tests did not finish in time.", [GOOD, HUNG], [GOOD] * 3),
        ("The tests did not finish in time on other nodes, so some runs did not take place.", [GOOD], [GOOD, HUNG]),
        ("A test that waits for a message that never arrives must give up", [GOOD, HUNG], [BAD] * 3),
        (
            "The tests did not finish in time on the correct node.",
            [dataclasses.replace(HUNG, node="")] * 3,
            [dataclasses.replace(BAD, test="", exit_code=4)] * 3,
        ),
        (
            "The tests on the correct node ended with exit code 4.",
            [dataclasses.replace(BAD, test="", exit_code=4)] * 3,
            [BAD] * 3,
        ),
    ],
)
def test_a_sentence_about_the_correct_node_is_true(words: str, true: list[NodeRun], near: list[NodeRun]) -> None:
    assert words in about_pass(*true)
    assert words not in about_pass(*near)


STOP = dataclasses.replace(BAD, node="stop")
DOES = "a node that never stops"


def about_stop(*runs: NodeRun) -> str:
    return told(found(CATCHES, given(*runs), broken="stop", does=DOES, cause="Publish after the wall."))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        (f"test_it fails on {DOES}, as required.", [GOOD, STOP], [GOOD, dataclasses.replace(GOOD, node="stop")]),
        (f"No test fails on {DOES}.", [GOOD, dataclasses.replace(GOOD, node="stop")], [GOOD, STOP]),
        (f"At least one test fails on {DOES}.", [GOOD, dataclasses.replace(GOOD, node="stop")], [GOOD, STOP]),
        ("At least one test fails on", [GOOD, HUNG], [GOOD, STOP]),
        ("No test fails on", [GOOD, dataclasses.replace(SKIPPED, node="stop")], [GOOD, HUNG]),
        ("The tests did not finish in time.", [GOOD, HUNG], [GOOD, STOP]),
    ],
)
def test_a_sentence_about_a_broken_node_is_true(words: str, true: list[NodeRun], near: list[NodeRun]) -> None:
    assert words in about_stop(*true)
    assert words not in about_stop(*near)


NONE_FOUND = NodeRun("", 5)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("pytest finds 3 tests.", (GOOD, SOURCE), (NONE_FOUND, SOURCE)),
        ("The files contain 1 test.", (NONE_FOUND, SOURCE), (GOOD, SOURCE)),
        (
            "pytest finds a test file, but cannot import it.",
            (dataclasses.replace(NONE_FOUND, outcome="import"), ""),
            (NONE_FOUND, ""),
        ),
        ("pytest finds no test.", (NONE_FOUND, "def it():\n    pass\n"), (NONE_FOUND, SOURCE)),
        (
            "pytest finds tests: functions named test_SOMETHING in files named test_SOMETHING.py.",
            (NONE_FOUND, "def it():\n    pass\n"),
            (GOOD, SOURCE),
        ),
    ],
)
def test_a_sentence_about_found_tests_is_true(words: str, true: tuple[NodeRun, str], near: tuple[NodeRun, str]) -> None:
    assert words in told(FOUND.check(given(true[0], source=true[1]), NoParams()))
    assert words not in told(FOUND.check(given(near[0], source=near[1]), NoParams()))


def test_the_address_of_an_object_is_not_in_the_report() -> None:
    message = "assert 1.1 == <function approx at 0x7f1111fe9800>"
    assert "fails on the correct node: assert 1.1 == <function approx>." in about_pass(
        *[dataclasses.replace(BAD, message=message)] * 3
    )


def why_accepted(node: str, body: str, run: NodeRun = GOOD) -> str:
    """Return what the student reads about a broken node of the course that the test with this body accepts."""
    check = next(check for check in find_exercise("12-tests").checks if check.id == node)
    source = f"bench = WallGuard()\n\n\ndef test_it(bench):\n{body}\n    assert bench.count() == 10\n"
    return told(CATCHES.judge(given(GOOD, dataclasses.replace(run, node=node), source=source), check.params))


@pytest.mark.parametrize(
    ("node", "body", "words"),
    [
        (
            "speed",
            "    assert bench.x == pytest.approx(1.1, abs=0.5)",
            "abs=0.5 allows so large a difference that wrong values pass.",
        ),
        ("speed", "    assert bench.x == pytest.approx(1.1, 1e-3, 0.5)", "abs=0.5 allows so large a difference"),
        ("speed", "    assert math.isclose(bench.x, 1.1, abs_tol=0.5)", "abs_tol=0.5 allows so large a difference"),
        ("speed", "    assert math.isclose(bench.x, 1.1)", None),
        ("speed", "    assert bench.x == pytest.approx(1.1, abs=0.01)", None),
        ("speed", "    assert len(bench.heard) == pytest.approx(10, abs=1)", None),
        ("rate", "    assert bench.x == pytest.approx(1.1, abs=0.5)", None),
        ("early", "    assert bench.x == pytest.approx(1.1, abs=0.5)", None),
        ("speed", "    math.isclose(bench.x, 1.1)", "Without assert before it, a comparison has no effect."),
        ("speed", "    bench.x == 1.1", "Without assert before it, a comparison has no effect."),
        (
            "speed",
            "    with suppress(AssertionError):\n        assert bench.x == 1.1",
            "suppress catches the Assertion",
        ),
    ],
)
def test_what_weakens_a_test_is_reported(node: str, body: str, words: str | None) -> None:
    told_ = why_accepted(node, body)
    missing = {
        "speed": "No test requires that linear.x is",
        "rate": "No test requires a command every",
        "early": "No test",
    }
    assert (words or missing[node]) in told_


def test_a_test_that_was_skipped_on_the_broken_node_is_reported() -> None:
    skipped = dataclasses.replace(GOOD, passed=2, skipped=1)
    assert "pytest ignores the failure of 1 test" in why_accepted("speed", "    pass", skipped)


def test_a_constant_in_one_of_two_tests_is_reported() -> None:
    body = "    assert True\n\n\ndef test_other(bench):"
    assert "assert True never fails." in why_accepted("rate", body)


def test_a_syntax_error_in_the_tests_has_its_line_and_its_cause() -> None:
    run = dataclasses.replace(BAD, test=TESTS, outcome="import", message="SyntaxError: expected ':'", line=0)
    finding = PASS.check(given(*[run] * 3, source="import os\n\n\ndef test_it(bench)\n    assert bench\n"), NoParams())
    assert finding.diagnosis == "colon-missing"
    assert finding.where is not None
    assert (finding.where.file, finding.where.line) == (TESTS, 4)


def test_tests_that_never_create_the_node_are_named() -> None:
    check = next(check for check in find_exercise("12-tests").checks if check.id == "speed")
    run = dataclasses.replace(GOOD, node="speed")
    words = "The tests never create an object of the class WallGuard, so they do not test the node."
    for first, events, found_ in (
        ("", None, True),
        ("guard = WallGuard()\n", None, False),
        ("", NodeEvents(calls=1, all_calls=1), False),
    ):
        evidence = given(GOOD, dataclasses.replace(run, events=events), source=f"{first}{SOURCE}")
        assert (words in told(CATCHES.judge(evidence, check.params))) == found_

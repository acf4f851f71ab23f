"""The checks of a student's tests, with made-up results."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise, load_exercise
from grader.checks.judge import judge
from grader.checks.kind import NoParams
from grader.checks.outcome import Status
from grader.checks.subjects.tests_run import CATCHES, PASS
from grader.checks.subjects.tests_written import ASSERTS, OUTSIDE
from grader.errors import UsageError
from grader.evidence.evidence import Evidence, Run
from grader.evidence.recording_format import load, save
from grader.report.html import html_page
from grader.report.report import report_of
from grader.report.scene import scene_of
from grader.testbench.result import BenchResult, Ended, NodeRun, run_of
from grader.tests.checks import made

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
    found = passes(*order)
    assert (found.status, found.diagnosis) == (Status.FAILED, "unsteady-tests")
    assert f"in {order.count(GOOD)} of 3 runs" in found.observed


def test_a_missing_run_on_the_right_node_is_no_pass() -> None:
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
    [b"", b"[]", b"{", b'{"cases": 3, "collected": "x"}', b'{"cases": [1, {"outcome": []}], "collected": -1}', b"\xff"],
)
def test_a_forged_report_is_read_as_far_as_it_can_be(report: bytes) -> None:
    assert run_of(Ended("rate", 1, report=report)).exit_code == 1
    assert run_of(Ended("rate", 1, report=report)).collected == 0


def test_a_report_about_tests_does_not_say_that_the_node_was_not_run() -> None:
    evidence = given(BAD, BAD, BAD)
    report = report_of(evidence, judge(evidence), "none", {})
    assert "The node was not run, so" not in html_page(evidence, report)
    assert scene_of(evidence).notice == "The tests need no turtle."
    assert report.clock_why == "Your tests were run 3 times."


def test_a_recording_of_tests_is_judged_again(tmp_path: Path) -> None:
    evidence = given(GOOD, GOOD, GOOD, dataclasses.replace(BAD, node="stop"))
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


@pytest.mark.parametrize(
    ("code", "diagnosis"),
    [
        ("import platform\nassert platform.system()\n", None),
        ("from unittest import mock\n", None),
        ("import inspect\n", "looks-at-source"),
        ("import ast as tree\n", "looks-at-source"),
        ("def test_it(guard):\n    assert guard.send.__code__\n", "looks-at-source"),
        ("from pathlib import Path\ntext = Path('x').read_text()\n", "looks-at-source"),
        ("from subprocess import Popen\n", "starts-a-process"),
        ("import launch_testing.actions\n", "starts-a-process"),
    ],
)
def test_what_looks_at_the_source_is_found_by_what_it_uses(code: str, diagnosis: str | None) -> None:
    assert OUTSIDE.check(given(source=code), NoParams()).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("body", "diagnosis"),
    [
        ("    check(bench)\n\ndef check(bench):\n    assert bench\n", None),
        ("    with pytest.raises(ValueError):\n        bench()\n", None),
        ("    bench.guard.publish.assert_called_once()\n", None),
        ("    return bench.count() == 10\n", "compares-only"),
        ("    bench.count() == 10\n", "compares-only"),
        ("    assert (bench.count() == 10, 'ten')\n", "assert-tuple"),
        ("    print(bench.count())\n", "no-assert"),
    ],
)
def test_a_test_needs_an_assert_that_can_fail(body: str, diagnosis: str | None) -> None:
    assert ASSERTS.check(given(source=f"def test_it(bench):\n{body}"), NoParams()).diagnosis == diagnosis

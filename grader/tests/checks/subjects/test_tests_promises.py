"""Tests of a node that use its methods, or that loop for a fixed time."""

from __future__ import annotations

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kind import NoParams
from grader.checks.outcome import Finding, Status
from grader.checks.subjects.tests_promises import PROMISES
from grader.checks.subjects.tests_written import STEADY, Steady
from grader.evidence.evidence import Evidence
from grader.submission.where import Where
from grader.tests.checks import made

TESTS = "test/test_wall_guard.py"
NODE = "my_robot_controller/wall_guard.py"
GUARD = """
class WallGuard(Node):
    def __init__(self):
        self.pose = None

    def send(self):
        self.at = 1
"""
OUTSIDE = (
    "class Bench:\n    def __init__(self):\n        self.guard = WallGuard()\n\n"
    "    def pose(self):\n        self.guard.get_clock()\n\n"
    "def test_it(bench):\n    bench.pose()\n    assert bench.at == 1\n"
)


def given(tests: str) -> Evidence:
    return Evidence(find_exercise("12-tests"), made.submission({TESTS: tests, NODE: GUARD}))


def test_a_bench_may_have_methods_with_the_same_names() -> None:
    assert PROMISES.check(given(OUTSIDE), NoParams()).status is Status.PASSED


@pytest.mark.parametrize(
    ("tests", "line"),
    [
        (OUTSIDE.replace("bench.at", "bench.guard.at"), 10),
        (OUTSIDE.replace("self.guard.get_clock()", "self.guard.send()"), 6),
        ("def test_it():\n    node = WallGuard()\n    assert node.pose is None\n", 3),
        ("def fresh():\n    yield WallGuard()\n\ndef test_it(fresh):\n    fresh.send()\n", 5),
        ("def test_it(anything):\n    WallGuard.send(anything)\n", 2),
    ],
)
def test_a_method_or_an_attribute_of_the_node_is_no_promise(tests: str, line: int) -> None:
    found = PROMISES.check(given(tests), NoParams())
    assert (found.diagnosis, found.where) == ("uses-own-names", Where(TESTS, line))


@pytest.mark.parametrize(
    ("imported", "diagnosis"),
    [
        ("WallGuard, SLOW", "uses-own-names"),
        ("helper, PERIOD_S", "uses-own-names"),
        ("LOW, HIGH", "uses-own-names"),
        ("WallGuard, helper, main", None),
    ],
)
def test_every_constant_of_the_node_is_found(imported: str, diagnosis: str | None) -> None:
    node = f"SLOW: float = 0.5\nPERIOD_S = 0.1\nLOW, HIGH = 1, 2\n\ndef helper():\n    pass\n{GUARD}"
    tests = f"from my_robot_controller.wall_guard import {imported}\n"
    evidence = Evidence(find_exercise("12-tests"), made.submission({TESTS: tests, NODE: node}))
    assert PROMISES.check(evidence, NoParams()).diagnosis == diagnosis


LOOP = """def test_it(bench):
    end = time.time() + 1
    while time.time() < end:
        bench.spin()
    assert bench.heard
"""


def steady(tests: str) -> Finding:
    return STEADY.check(given(tests), Steady(names=("sleep",), random=("randint",)))


def test_a_loop_for_a_fixed_time_is_a_sleep() -> None:
    found = steady(LOOP)
    assert (found.diagnosis, found.where) == ("sleeps-by-luck", Where(TESTS, 3))


@pytest.mark.parametrize(
    "right",
    [
        LOOP.replace("while time.time() < end:", "while not bench.heard and time.time() < end:"),
        LOOP.replace("bench.spin()\n", "bench.spin()\n        if bench.heard:\n            break\n"),
        LOOP.replace("time.time()", "bench.now"),
    ],
)
def test_a_deadline_is_not_a_sleep(right: str) -> None:
    assert steady(right).status is Status.PASSED

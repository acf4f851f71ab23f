"""The reasons why a test receives no message, each with a run in which one thing is different."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.causes.why_not_heard import why_not_called, why_not_heard
from grader.exercise.node_under_test import Behaviour
from grader.submission.pytest_files import read_test_code
from grader.testbench.result import LATEST_S, NodeEvents, NodeRun

FILE = "test/test_it.py"
BENCH = """\
class Bench:
    def __init__(self):
        self.listener.create_subscription(Twist, "/turtle1/cmd_vel", self.heard.append, 10)
        self.poses = self.listener.create_publisher(Pose, "/turtle1/pose", 10)
        self.executor.add_node(self.guard)

    def run(self):
        self.guard.get_clock().set_ros_time_override(self.now)
        self.executor.spin_once(timeout_sec=0)


def test_it(bench):
    assert len(bench.heard) == 10
"""
WITHOUT_CLOCK = BENCH.replace("set_ros_time_override", "now")
NONE = "IndexError: list index out of range"
FIVE = "assert 5 == 10\n +  where 5 = len([Twist(), Twist()])"
NINE = FIVE.replace("5", "9")
VALUE = "assert 1.1 == 1.2 ± 1.2e-06"
RIGHT = NodeEvents(poses=1, calls=10, commands=10, first_s=0.1, clock_s=1.1, all_calls=10)
UNSTARTED = replace(RIGHT, calls=9, commands=9, first_s=0.0, clock_s=1.0)
NOTHING = NodeEvents()
STOOD = replace(RIGHT, calls=0, commands=0, clock_s=0.1, all_calls=0)
OF_DAY = replace(STOOD, first_s=LATEST_S, clock_s=LATEST_S)
NO_POSE = replace(RIGHT, poses=0, commands=0)
LATE_POSE = replace(RIGHT, commands=0)
RARE = replace(RIGHT, calls=4, commands=4)


def cause(message: str, events: NodeEvents | None, source: str = BENCH) -> str:
    """Return the diagnosis, the line and the text of the cause for this message of pytest and these events."""
    run = NodeRun("", 1, test=f"{FILE}::test_it", outcome="failed", message=message, events=events)
    found = why_not_heard(run, read_test_code({FILE: source.encode()}, "my_package"), Behaviour())
    return "" if found is None else f"{found.diagnosis} {found.where}: {found.text}"


@pytest.mark.parametrize(
    ("message", "events", "near", "begins", "words"),
    [
        (
            NONE,
            NOTHING,
            STOOD,
            "bench-not-spun test/test_it.py:5",
            "Is the node in the executor, and does the bench",
        ),
        (
            NONE,
            OF_DAY,
            STOOD,
            "bench-wall-time test/test_it.py:8",
            "The node's clock follows the system time, so set_",
        ),
        (VALUE, OF_DAY, RIGHT, "bench-wall-time test/test_it.py:8", "Set the node's parameter use_sim_time to True"),
        (
            NONE,
            STOOD,
            OF_DAY,
            "bench-clock-stands test/test_it.py:8",
            "the node's clock showed 0.1 s, but the callback",
        ),
        (
            NONE,
            replace(STOOD, first_s=0.0, clock_s=0.0),
            STOOD,
            "bench-clock-stands test/test_it.py:8",
            "Do the tests call this method, and on the clock of the node under test?",
        ),
        (NONE, STOOD, RIGHT, "bench-clock-stands", "The callback is due after a whole period: advance the clock"),
        (NONE, NO_POSE, RIGHT, "bench-no-pose test/test_it.py:4", "but no pose had arrived on /turtle1/pose. Does"),
        (
            NONE,
            LATE_POSE,
            NO_POSE,
            "bench-clock-stands",
            "The pose arrived after the last run of the timer's callback.",
        ),
        (
            NONE,
            RIGHT,
            LATE_POSE,
            "bench-not-heard test/test_it.py:3",
            "The node has published 10 commands on /turtle",
        ),
        (NONE, RIGHT, NO_POSE, "bench-not-heard", "Is the subscribing node in the executor, is its topic right"),
        (
            FIVE,
            RARE,
            RIGHT,
            "bench-loses-calls test/test_it.py:9",
            "On the node's clock, the timer's callback ran less than once per period (0.1 s).",
        ),
        (FIVE, RARE, RIGHT, "bench-loses-calls", "Each call to spin_once runs at most one callback. If one step"),
        (NINE, UNSTARTED, RIGHT, "bench-clock-not-started", "The pose arrived when the node's clock showed 0 s, which"),
        (NINE, UNSTARTED, RIGHT, "bench-clock-not-started", "Advance the clock by one step before the tests begin."),
    ],
)
def test_what_happened_in_the_node_decides(
    message: str, events: NodeEvents, near: NodeEvents, begins: str, words: str
) -> None:
    text = cause(message, events)
    assert text.startswith(begins)
    assert words in text
    assert words not in cause(message, near)


@pytest.mark.parametrize("message", [VALUE, "assert 12 == 10\n +  where 12 = len([Twist()])", "assert False", ""])
@pytest.mark.parametrize("events", [RIGHT, NOTHING, STOOD, NO_POSE, RARE, UNSTARTED])
def test_a_test_that_received_enough_is_not_told_about_the_bench(message: str, events: NodeEvents) -> None:
    assert cause(message, events) == ""


@pytest.mark.parametrize(
    "message",
    [
        NONE,
        "assert 0 == 10\n +  where 0 = len([])",
        "assert []\n +  where [] = <Bench>.heard",
        "AttributeError: 'NoneType' object has no attribute 'linear'",
        "ValueError: max() arg is an empty sequence",
    ],
)
def test_each_sign_of_an_empty_list_is_known(message: str) -> None:
    assert cause(message, RIGHT).startswith("bench-not-heard")


def test_a_bench_that_leaves_the_time_of_day_is_not_shown_a_time() -> None:
    text = cause(NONE, OF_DAY, WITHOUT_CLOCK)
    assert text.startswith("bench-clock-stands test/test_it.py: A pose arrived, but the callback of the node's timer")
    assert "The node's clock follows the system time. Set its parameter use_sim_time to True" in text
    assert "follows the system time" not in cause(NONE, STOOD, WITHOUT_CLOCK)


def test_a_bench_in_wall_time_may_use_the_time_of_day() -> None:
    assert cause(NONE, replace(RIGHT, clock_s=LATEST_S), WITHOUT_CLOCK).startswith("bench-not-heard")
    assert cause(VALUE, replace(RIGHT, clock_s=LATEST_S), WITHOUT_CLOCK) == ""


def test_an_old_recording_without_events_shows_nothing() -> None:
    assert cause(NONE, None) == ""


@pytest.mark.parametrize(
    ("events", "diagnosis"),
    [(NOTHING, "bench-not-spun"), (STOOD, "bench-clock-stands"), (OF_DAY, "bench-wall-time"), (RIGHT, None)],
)
def test_a_run_in_which_no_timer_fired_says_nothing_about_the_tests(events: NodeEvents, diagnosis: str | None) -> None:
    run = NodeRun("speed", 0, collected=3, passed=3, events=events)
    found = why_not_called(run, read_test_code({FILE: BENCH.encode()}, "my_package"), Behaviour())
    assert (None if found is None else found.diagnosis) == diagnosis


@pytest.mark.parametrize(("source", "told"), [("def test_it():\n    assert guard\n", True), (BENCH, False)])
def test_tests_that_never_spin_are_told_so(source: str, *, told: bool) -> None:
    words = "No test spins the node, so no callback of the node runs. Call spin_once in the tests."
    assert (words in cause(NONE, NOTHING, source)) == told

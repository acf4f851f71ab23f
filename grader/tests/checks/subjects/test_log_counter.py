"""The counter in the log lines: where it starts, and by how much it increases."""

from __future__ import annotations

import pytest

from grader.checks.subjects.log import LOG_COUNTER
from grader.tests.checks.made import NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.node_log import HELLO, LOGS, hello


@pytest.mark.parametrize(
    ("numbers", "diagnosis", "observed"),
    [
        ((0, 1, 2, 3), None, "The counter starts at 0 and increases by one per line."),
        ((1, 2, 3), "counter-start", "The first number is 1."),
        ((5, 6, 7), "counter-start", "The first number is 5."),
        ((0, 0, 0), "counter-stuck", "The number is always 0."),
        ((0, 2, 4), "counter-step", "The number after 0 is 2."),
        ((0, 1, 1, 2), "counter-step", "The number after 1 is 1."),
        ((3, 2, 1), "counter-step", "The number after 3 is 2."),
    ],
)
def test_each_counter_has_its_diagnosis_and_place(
    numbers: tuple[int, ...], diagnosis: str | None, observed: str
) -> None:
    trial = recording([], log=hello(*numbers))
    finding = found(LOG_COUNTER, evidence(trial), format=HELLO, counts="counter")
    assert (finding.diagnosis, finding.observed) == (diagnosis, observed)
    assert str(finding.where) == ("None" if diagnosis is None else NODE_FILE)
    assert ("Log the number first, then increase it." in finding.cause) == (numbers[0] == 1)


def test_the_place_of_a_counter_is_the_line_that_logs_it() -> None:
    source = LOGS.replace("super()", 'self.get_logger().info("Hello")\n        super()', 1)
    source = source.replace('info("...")', 'info(f"Hello {self.count}")')
    line = source[: source.index('f"Hello')].count("\n") + 1
    given = evidence(recording([], log=hello(3, 2, 1)), submission({NODE_FILE: source}))
    assert str(found(LOG_COUNTER, given, format=HELLO, counts="counter").where) == f"{NODE_FILE}:{line}"


def test_one_line_is_too_few_for_a_counter_and_two_are_enough() -> None:
    for log, diagnosis in ((hello(0), "too-few-log-lines"), (hello(0, 1), None)):
        trial = recording([], log=log)
        finding = found(LOG_COUNTER, evidence(trial, submission({NODE_FILE: LOGS})), format=HELLO, counts="counter")
        assert (finding.diagnosis, finding.where is not None) == (diagnosis, diagnosis is not None)
        assert finding.expected in ('"Hello 0", then "Hello 1", and so on.', "")


@pytest.mark.parametrize(("numbers", "few"), [((0,), True), ((0, 1), False)])
def test_one_line_is_too_few_to_compare(numbers: tuple[int, ...], *, few: bool) -> None:
    finding = found(LOG_COUNTER, evidence(recording([], log=hello(*numbers))), format=HELLO, counts="counter")
    assert (finding.observed == "There are fewer than two lines to compare.") == few


@pytest.mark.parametrize(("begins", "cause"), [(1, "Start with 0."), (0, "Log the number first, then increase it.")])
def test_a_counter_that_begins_at_1_is_told_from_one_that_is_increased_too_early(begins: int, cause: str) -> None:
    source = f"class Node:\n    def __init__(self):\n        self.counter = {begins}\n\n    def call(self):\n"
    changed = submission({NODE_FILE: source + "        self.counter += 1\n"})
    trial = recording([], log=hello(1, 2, 3))
    finding = found(LOG_COUNTER, evidence(trial, package=changed), format=HELLO, counts="counter")
    assert finding.cause == cause

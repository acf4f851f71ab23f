"""Nothing spins the node, or nothing calls a method: which of the two a silent node is told."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_silent import why_nothing
from grader.tests.checks.causes.test_why_silent import NODE, TIMER, given

SENDS = ("publish",)
STOP = "\n\nclass Other(Node):\n    def stop(self):\n        self.publisher.publish(1)\n"


@pytest.mark.parametrize(
    ("last", "diagnosis"), [("print(Driver())", "no-spin"), ("rclpy.spin(Driver())", "method-never-called")]
)
def test_a_second_method_that_nothing_calls_is_the_last_guess(last: str, diagnosis: str) -> None:
    cause = why_nothing(given(NODE.format(made=TIMER, sent="pass").replace("rclpy.spin(Driver())", last) + STOP), SENDS)
    assert cause is not None
    assert cause.diagnosis == diagnosis


@pytest.mark.parametrize(
    ("made", "found"), [("", False), ("node.create_timer(0.5, send)", True), ("node.create_client(A, 'a')", True)]
)
def test_a_loop_that_sends_needs_no_spin_if_nothing_has_a_callback(made: str, *, found: bool) -> None:
    cause = why_nothing(given(f"{made}\nwhile near():\n    publisher.publish(Twist())\n"), SENDS)
    assert (cause is not None and cause.diagnosis == "no-spin") == found


@pytest.mark.parametrize(
    ("made", "words", "line"),
    [
        ("rate = self.create_rate(2); rate.sleep()", "The method sleep of a Rate waits forever, because nothing", 5),
        ("self.create_timer(0.5, self.send)", "Without rclpy.spin, no timer callback is ever called.", None),
        ("time.sleep(0.5)", "Without rclpy.spin, no timer callback is ever called.", None),
    ],
)
def test_a_rate_needs_somebody_who_spins(made: str, words: str, line: int | None) -> None:
    source = NODE.format(made=made, sent="pass").replace("rclpy.spin(Driver())", "Driver().send()")
    cause = why_nothing(given(source), ("publish",))
    assert cause is not None
    assert cause.where is not None
    assert (cause.text.startswith(words), cause.where.line) == (True, line)

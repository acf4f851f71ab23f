"""The reasons why a student's tests do not end, each with tests that are nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_hung import LOOP, why_hung
from grader.submission.pytest_files import read_test_code

OWN = "    def spin(self):\n        self.executor.spin_once(timeout_sec=0)\n"


@pytest.mark.parametrize(
    ("body", "words", "line"),
    [
        ("rclpy.spin(guard)", "rclpy.spin does not return, so the test does not go on.", 3),
        ("executor.spin()", "executor.spin does not return, so the test does not go on.", 3),
        ("bench.spin()", LOOP, 2),
        ("executor.spin_once()", "Without timeout_sec, spin_once waits until a callback is ready.", 3),
        ("rclpy.spin_once(guard)", "Without timeout_sec, spin_once waits until a callback is ready.", 3),
        ("executor.spin_once(0)", LOOP, 2),
        ("rclpy.spin_once(guard, timeout_sec=0)", LOOP, 2),
        ("while True:\n        bench.run(1)", "This loop has no end.", 3),
        ("while True:\n        if bench.run(1):\n            break", LOOP, 2),
        ("while not bench.heard:\n        bench.run(1)", LOOP, 2),
    ],
)
def test_the_call_or_the_loop_that_never_ends_is_named(body: str, words: str, line: int) -> None:
    bench = f"class Bench:\n{OWN}" if "bench.spin" in body else ""
    source = f"import rclpy\ndef test_it(bench, guard, executor):\n    {body}\n{bench}"
    cause = why_hung(read_test_code({"test/test_guard.py": source.encode()}, "my_package"), None)
    assert cause.text.startswith(words)
    assert cause.where is not None
    assert cause.where.line == line

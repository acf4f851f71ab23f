"""Asserts that hold on every node, each with an assert that can fail."""

from __future__ import annotations

import pytest

from grader.checks.causes.vacuous_asserts import vacuous_assert, value_as_message
from grader.submission.pytest_files import read_test_code

CONSTANT = "11 alone counts as true, so the condition always holds. Repeat the comparison after or."
LENGTH = "A length is never less than 0, so the condition always holds. Write the number that you expect."
WALRUS = ":= assigns a value, which counts as true. To compare two values, write == between them."
OBJECT = "is not compares two objects, and a new list is always another object. Write != instead."
LAMBDA = "A function counts as true, and this one is never called. Write the condition without lambda."
GENERATOR = "A generator counts as true, and nothing runs its condition. Call all(...) or any(...) with it."
ITSELF = "This compares a value with itself. Compare it with the number that the node promises."


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("    assert len(bench.heard) == 10 or 11", CONSTANT),
        ("    assert len(bench.heard) == 10 or len(bench.heard) == 11", None),
        ("    assert len(bench.heard) == 10 or 0", None),
        ("    assert len(bench.heard) == 10 and 11", None),
        ("    assert [len(bench.heard) == 10]", "A list or set that is not empty counts as true. Remove the brackets."),
        ("    assert []", None),
        ("    assert [len(bench.heard)] == [10]", None),
        ("    assert lambda: bench.heard", LAMBDA),
        ("    assert (each.x == 1.0 for each in bench.heard)", GENERATOR),
        ("    assert all(each.x == 1.0 for each in bench.heard)", None),
        ("    assert (number := 10)", WALRUS),
        ("    assert (number := len(bench.heard))", None),
        ("    assert len(bench.heard) >= 0", LENGTH),
        ("    assert len(bench.heard) > 0", None),
        ("    assert len(bench.heard) >= 1", None),
        ("    assert bench.heard[-1].x >= 0", None),
        ("    assert bench.heard is not []", OBJECT),
        ("    assert bench.heard is not None", None),
        ("    assert bench.heard[-1] == bench.heard[-1]", ITSELF),
        ("    last = bench.heard[-1]\n    assert last.linear.x == bench.heard[-1].linear.x", ITSELF),
        ("    last = bench.heard[-1]\n    assert last.linear.x == bench.heard[-2].linear.x", None),
        ("    last = bench.heard[-1]\n    bench.run(1)\n    assert last.linear.x == bench.heard[-1].linear.x", None),
        ("    last = bench.count()\n    assert last == bench.count()", None),
        ("    assert bench.count() == bench.count()", None),
        ("    assert bench.heard[-1] != bench.heard[-1]", None),
    ],
)
def test_only_an_assert_that_cannot_fail_is_found(body: str, words: str | None) -> None:
    source = f"def test_it(bench):\n{body}\n"
    cause = vacuous_assert(read_test_code({"test/test_guard.py": source.encode()}, "my_package"))
    assert (None if cause is None else cause.text) == words
    assert cause is None or (cause.where is not None and cause.where.line == source.count("\n"))


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("assert command.angular.z, TURN", True),
        ("assert command.angular.z, 1.2", True),
        ("assert command.angular.z, 'no turn'", False),
        ("assert command.angular.z, message", False),
        ("assert command.angular.z == TURN, TURN", False),
        ("assert bench.heard[-1] == TURN", False),
    ],
)
def test_only_a_value_after_the_comma_belongs_after_an_operator(line: str, *, found: bool) -> None:
    source = f"def test_it(bench):\n    {line}\n"
    cause = value_as_message(read_test_code({"test/test_guard.py": source.encode()}, "my_package"))
    words = "An assert checks only the part before the comma. To compare two values, write == between them."
    assert (cause is not None and cause.text == words) == found

"""The sentences about tests that prove nothing, each with a test that proves something."""

from __future__ import annotations

import pytest

from grader.checks.causes.weak_tests import (
    always_false,
    always_true,
    in_a_loop,
    named_twice,
    why_without_assert,
)
from grader.submission.pytest_files import TestCode, read_test_code

SEARCH = "    for each in bench.heard:\n        if each.linear.x == 0.0:\n            return\n"


def code(body: str, above: str = "") -> TestCode:
    """Return a test file with one test. `above` is the source code above the test."""
    return read_test_code({"test/test_guard.py": f"{above}def test_it(bench):\n{body}\n".encode()}, "my_package")


@pytest.mark.parametrize(
    ("body", "words", "line"),
    [
        ("    bench.count() == 10", "Without assert before it, a comparison has no effect.", 2),
        ("    return bench.count() == 10", "pytest ignores the return value of a test. Write assert instead", 2),
        ("    print(bench.count())", "A test without an assert fails only if something raises an exception.", 1),
        ("    print(3)\n    assert True", "assert True never fails. Compare a message with a value", 3),
        (
            "    def done():\n        return bench.count() == 10\n    bench.spin(done)",
            "A test without an assert fails only if something raises an exception.",
            1,
        ),
    ],
)
def test_what_a_test_has_in_place_of_an_assert_is_told(body: str, words: str, line: int) -> None:
    given = code(body)
    cause = why_without_assert(given.tests[0])
    assert (cause.text.startswith(words), cause.where and cause.where.line) == (True, line)
    others = {
        "Without assert before it",
        "pytest ignores the return value",
        "A test without an assert fails",
        "never fails",
    }
    assert [each for each in others if each in cause.text] == [each for each in others if each in words]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("    assert (bench.count() == 10, 'ten')", True),
        ("    assert (bench.count() == 10), 'ten'", False),
        ("    assert bench.count() == (10, 'ten')", False),
    ],
)
def test_an_assert_of_a_tuple_is_always_true(body: str, *, found: bool) -> None:
    cause = always_true(code(body))
    words = "assert (condition, message) tests a tuple, which is always true. Remove the parentheses."
    assert (cause is not None and cause.text == words) == found


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("    assert False, 'to do'", True),
        ("    pytest.fail('to do')", True),
        ("    bench.motor.fail()", False),
        (f"{SEARCH}    assert False, 'never zero'", False),
        ("    if not bench.heard:\n        pytest.skip('silent')\n    assert False", False),
        ("    if not bench.heard:\n        pytest.fail('silent')", False),
        ("    assert bench.heard", False),
    ],
)
def test_only_a_test_that_cannot_end_earlier_always_fails(body: str, *, found: bool) -> None:
    cause = always_false(code(body))
    assert (cause is not None) == found
    assert cause is None or cause.text == "test_it fails on every node, even on the correct node."


@pytest.mark.parametrize(
    ("mark", "found"), [("skip", False), ("xfail(strict=True)", False), ("parametrize('a', [1])", True)]
)
def test_a_test_that_is_marked_as_skipped_or_failing_does_not_count(mark: str, *, found: bool) -> None:
    given = read_test_code(
        {"test/test_guard.py": f"@pytest.mark.{mark}\ndef test_it():\n    assert False\n".encode()}, "x"
    )
    assert (always_false(given) is not None) == found


@pytest.mark.parametrize(
    ("above", "listed", "found"),
    [
        ("", "bench.heard", True),
        ("heard = []\n", "heard", True),
        ("SPEEDS = [0.5, 1.0]\n", "SPEEDS", False),
        ("SPEEDS = (0.5, 1.0)\n", "SPEEDS", False),
        ("", "range(3)", False),
        ("", "[0.5, 1.0]", False),
    ],
)
def test_a_loop_over_what_may_be_empty_is_found(above: str, listed: str, *, found: bool) -> None:
    cause = in_a_loop(code(f"    for each in {listed}:\n        assert each", above))
    words = "If there is nothing to loop over, for example no message, the assert in this loop never runs."
    assert (cause is not None and cause.text == words) == found


@pytest.mark.parametrize(
    ("before", "found"),
    [
        ("if not bench.heard:\n        pytest.fail('silent')", False),
        ("if not bench.heard:\n        raise AssertionError('silent')", False),
        ("assert_heard(bench)", False),
        ("print(bench.heard)", True),
    ],
)
def test_what_fails_before_the_loop_proves_that_something_arrived(before: str, *, found: bool) -> None:
    cause = in_a_loop(code(f"    {before}\n    for each in bench.heard:\n        assert each"))
    assert (cause is not None) == found


@pytest.mark.parametrize(
    ("source", "line"),
    [
        ("def test_a():\n    pass\n\ndef test_a():\n    pass\n", 1),
        ("def test_a():\n    pass\n\ndef test_b():\n    pass\n", None),
        (
            "class TestX:\n    def test_a(self):\n        pass\n\nclass TestY:\n    def test_a(self):\n        pass\n",
            None,
        ),
    ],
)
def test_only_a_name_in_the_same_place_replaces_a_test(source: str, line: int | None) -> None:
    cause = named_twice(read_test_code({"test/test_guard.py": source.encode()}, "my_package"))
    assert (cause is not None and cause.where is not None and cause.where.line) == (line or False)
    words = "Another test on line 4 is also named test_a, so pytest never runs this one."
    assert (cause is not None and cause.text == words) == (line is not None)

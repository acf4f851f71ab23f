"""The reasons why there is nothing for pytest to collect, each with a file that pytest collects."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_no_test import why_no_test
from grader.submission.pytest_files import read_test_code

CHECK = "def check_it(bench):\n    assert bench\n"
TEST = "def test_it(bench):\n    assert bench\n"
INSIDE = "    def test_it(self):\n        assert self\n"
INIT = "    def __init__(self):\n        pass\n"


@pytest.mark.parametrize(
    ("file", "source", "near", "words"),
    [
        (
            "test/guard_tests.py",
            TEST,
            "x = 1\n",
            "pytest collects tests from files named test_SOMETHING.py. It ignores guard_tests.py.",
        ),
        (
            "my_package/node.py",
            TEST,
            None,
            "The tests belong in a file test/test_SOMETHING.py.",
        ),
        (
            "test/test_guard.py",
            f"class TestGuard:\n{INIT}{INSIDE}",
            f"class Guard:\n{INIT}{INSIDE}",
            "pytest ignores a test class that has an __init__. Use a fixture, or setup_method.",
        ),
        (
            "test/test_guard.py",
            f"class Guard:\n{INSIDE}",
            f"class Guard:\n{INSIDE.replace('test_it', 'it')}",
            "pytest ignores the class Guard, because its name does not begin with Test.",
        ),
        (
            "test/test_guard.py",
            CHECK,
            f"{CHECK}check_it(1)\n",
            "pytest ignores check_it, because its name does not begin with test.",
        ),
        ("test/test_guard.py", "x = 1\n", CHECK, "A test is a function whose name begins with test."),
    ],
)
def test_what_hides_a_test_is_told(file: str, source: str, near: str | None, words: str) -> None:
    assert why_no_test(read_test_code({file: source.encode()}, "my_package")).text == words
    other = {file: near.encode()} if near else {"test/test_guard.py": source.encode()}
    assert why_no_test(read_test_code(other, "my_package")).text != words

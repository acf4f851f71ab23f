"""The line that must change if lines of a block do not start at the same column."""

from __future__ import annotations

import pytest

from grader.checks.causes.syntax import unreadable_finding
from grader.submission.code import read_module
from grader.tests.checks.told import told

HEAD = "def main():\n    try:\n        spin()\n    finally:\n"
COLUMN = "All lines of a block must start at the same column"


def said(source: str) -> tuple[str, str]:
    """Return the place and the words about a file that Python cannot read."""
    unreadable = read_module("a.py", source.encode()).unreadable
    assert unreadable is not None
    found = unreadable_finding("a.py", unreadable, source.encode())
    assert found.diagnosis == "indentation"
    return str(found.where), told(found)


@pytest.mark.parametrize(
    ("body", "line", "widths"),
    [
        ("      stop()\n        end()\n", 5, "Line 5 starts with 6 spaces, and line 6 with 8."),
        ("          stop()\n        end()\n", 5, "Line 5 starts with 10 spaces, and line 6 with 8."),
        ("     # why\n      stop()\n\n        end()\n", 6, "Line 6 starts with 6 spaces, and line 8 with 8."),
        ("        stop()\n          end()\n", 6, ""),
        ("        stop()\n        end()\n      more()\n", 7, ""),
        ('        stop("""\n  """)\n          end()\n', 7, ""),
    ],
)
def test_the_line_with_the_unusual_indentation_is_named(body: str, line: int, widths: str) -> None:
    where, words = said(HEAD + body)
    assert where == f"a.py:{line}"
    assert COLUMN in words
    assert (widths in words) if widths else ("starts with" not in words)


def test_tabs_are_not_counted_as_spaces() -> None:
    where, words = said(HEAD.replace("    ", "\t") + "\t\t\tstop()\n\t\tend()\n")
    assert (where, "starts with" in words) == ("a.py:6", False)


@pytest.mark.parametrize(
    ("above", "decorator"), [("    @staticmethod\n", True), ("    value = 1\n    @property\n\n", True)]
)
def test_a_decorator_and_its_function_start_at_the_same_column(above: str, *, decorator: bool) -> None:
    source = f"class A:\n{above}def run():\n    pass\n"
    at = source[: source.index("def run")].count("\n") + 1
    where, words = said(source)
    assert where == f"a.py:{at}"
    number = source[: source.index("@")].count("\n") + 1
    assert (f"The decorator on line {number} belongs to line {at}" in words) == decorator


def test_a_block_without_a_decorator_says_nothing_about_one() -> None:
    assert "decorator" not in said("class A:\n    @staticmethod\n    def run():\n        pass\n      end()\n")[1]

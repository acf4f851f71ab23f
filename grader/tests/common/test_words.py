from __future__ import annotations

import math
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.common.words import UNSAFE_CATEGORIES, a_list, count, nearest, number, printable, shorten


@given(st.text())
def test_nothing_that_acts_on_a_terminal_is_left(text: str) -> None:
    shown = printable(text)
    assert [char for char in shown if unicodedata.category(char) in UNSAFE_CATEGORIES] == []
    assert "\n" not in shown


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("plain text, with ümlauts", "plain text, with ümlauts"),
        ("\x1b[31mred\x1b[0m", "?[31mred?[0m"),
        ("two\nlines\tand\r\nmore", "two lines and more"),
        ("left\u202eright", "left?right"),
        ("bad\udcff", "bad?"),
    ],
)
def test_printable(text: str, expected: str) -> None:
    assert printable(text) == expected


@given(st.text(), st.integers(4, 100))
def test_shortened_texts_fit(text: str, limit: int) -> None:
    assert len(shorten(text, limit)) <= limit


def test_short_texts_stay_as_they_are() -> None:
    assert shorten("abc") == "abc"
    assert shorten("a" * 70) == "a" * 57 + "..."


def test_nearest() -> None:
    assert nearest("cmd_val", ["pose", "cmd_vel"]) == "cmd_vel"
    assert nearest("x", ["pose", "cmd_vel"]) is None


def test_lists() -> None:
    assert [a_list([]), a_list(["a"]), a_list(["a", "b"]), a_list(["a", "b", "c"], "or")] == [
        "",
        "a",
        "a and b",
        "a, b or c",
    ]
    assert a_list([str(each) for each in range(7)]) == "0, 1, 2, 3, 4, 5 and 6"
    assert a_list([str(each) for each in range(9)], most=6) == "0, 1, 2, 3, 4, 5 and 3 more"
    assert a_list([str(each) for each in range(99)]).endswith("11 and 87 more")


@pytest.mark.parametrize(
    ("value", "unlike", "expected"),
    [
        (2.0, None, "2.0"),
        (0.1 + 0.2, None, "0.3"),
        (1234567.0, None, "1.235e+06"),
        (2.0000001, 2.0, "2.0000001"),
        (2.2, 2.0, "2.2"),
        (math.nan, None, "NaN (not a number)"),
        (-math.inf, None, "minus infinity"),
    ],
)
def test_numbers(value: float, unlike: float | None, expected: str) -> None:
    assert number(value, unlike) == expected


def test_counts() -> None:
    assert (count(1, "command"), count(2, "command")) == ("1 command", "2 commands")

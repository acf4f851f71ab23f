from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.turtlesim.programs.teleop_keys import Cancel, Drive, Key, Quit, Turn, keys


@pytest.mark.parametrize(
    ("typed", "key"),
    [
        ("\x1b[A", Drive(1.0, 0.0)),
        ("\x1b[B", Drive(-1.0, 0.0)),
        ("\x1b[D", Drive(0.0, 1.0)),
        ("\x1b[C", Drive(0.0, -1.0)),
        ("\x1bOA", Drive(1.0, 0.0)),
        ("\x1b[1;2D", Drive(0.0, 1.0)),
        ("g", Turn(0.0)),
        ("t", Turn(math.radians(45))),
        ("r", Turn(math.radians(90))),
        ("e", Turn(math.radians(135))),
        ("d", Turn(math.radians(180))),
        ("c", Turn(math.radians(-135))),
        ("v", Turn(math.radians(-90))),
        ("b", Turn(math.radians(-45))),
        ("R", Turn(math.radians(90))),
        ("f", Cancel()),
        ("q", Quit()),
        ("Q", Quit()),
    ],
)
def test_each_key_means_what_it_does_in_the_real_one(typed: str, key: Key) -> None:
    assert keys(typed) == ([key], "")


@pytest.mark.parametrize("other", ["x", "\n", " ", "\x1b[H", "\x1b[3~", "\x1b\x1b", "\xff"])
def test_other_keys_are_ignored(other: str) -> None:
    typed, rest = keys(other + "q")
    assert typed == [Quit()]
    assert rest == ""


def test_the_letters_inside_of_a_sequence_are_no_keys() -> None:
    # The key End sends ESC [ F, and F alone cancels.
    assert keys("\x1b[F") == ([], "")


@given(st.lists(st.sampled_from(["\x1b[A", "\x1bOD", "\x1b[1;5B", "g", "F", "x", "q"])), st.data())
def test_keys_are_the_same_however_the_bytes_are_cut(typed: list[str], data: st.DataObject) -> None:
    text = "".join(typed)
    cut = data.draw(st.integers(0, len(text)))
    first, rest = keys(text[:cut])
    second, rest = keys(rest + text[cut:])
    assert ([*first, *second], rest) == keys(text)

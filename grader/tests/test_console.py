from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from grader.authoring.console_blocks import Block, Step, blocks
from grader.tests.console import differs, run
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

TEXT = """\
# A text
```console
$ echo one; echo two
one
two
$ false
```
```python
print(1)
```
```console ros2
$ ros2 topic list
```
"""


def test_blocks_are_found_with_their_language() -> None:
    assert [(block.language, block.about) for block in blocks(TEXT)] == [
        ("console", ""),
        ("python", ""),
        ("console", "ros2"),
    ]


def test_a_block_is_commands_with_what_they_print() -> None:
    assert blocks(TEXT)[0].steps() == (Step("echo one; echo two", ("one", "two")), Step("false", ()))


def test_output_without_a_command_is_an_error() -> None:
    with pytest.raises(ValueError, match="output without a command"):
        Block("console", "", "one\n$ echo two\n").steps()


def test_commands_share_a_shell(tmp_path: Path) -> None:
    block = Block("console", "", "$ x=5; cd /\n$ printf $x$PWD\n$ (exit 3)\n")
    results = run(block, tmp_path, os.environ, HANG_S)
    assert [(printed, code) for _, printed, code in results] == [("", 0), ("5/", 0), ("", 3)]


@pytest.mark.parametrize(
    ("shown", "wrong"),
    [
        ((), None),
        (("a 1", "b"), None),
        (("b",), None),
        (("a 2.5",), None),
        (("a  3", "...", "d"), None),
        (("...", "c"), None),
        (("a 1", "c"), "c"),
        (("b", "a 1"), "a 1"),
        (("x",), "x"),
        (("d", "more"), "more"),
    ],
)
def test_what_is_shown_must_be_printed_in_that_order(shown: tuple[str, ...], wrong: str | None) -> None:
    assert differs(shown, "a 1\nb\nc\nd\n") == wrong


@pytest.mark.parametrize("duration", ["0.61s", "12.3s", "1min 0s", "1min 13s", "2h 0min 59s"])
def test_the_duration_of_a_build_is_not_compared(duration: str) -> None:
    assert differs(("1 package finished [1.75s]",), f"1 package finished [{duration}]") is None
    assert differs(("1 package finished [1.75s]",), f"1 package failed [{duration}]") is not None


@pytest.mark.parametrize(
    ("shown", "wrong"),
    [
        ("15 of 100 points in 2 s", False),
        ("15 of 100 points in 0.75 s", False),
        ("5 of 100 points in 2 s", True),
        ("15 of 90 points in 2 s", True),
    ],
)
def test_numbers_of_things_are_compared_and_times_are_not(shown: str, wrong: bool) -> None:
    assert (differs((shown,), "15 of 100 points in 1.25 s\n") is not None) == wrong


@pytest.mark.parametrize(("shown", "wrong"), [("✓ It drives  10/10", False), ("✓ It drives  15/15", True)])
def test_the_points_of_a_check_are_compared(shown: str, wrong: bool) -> None:
    assert (differs((shown,), "✓ It drives  10/10\n") is not None) == wrong

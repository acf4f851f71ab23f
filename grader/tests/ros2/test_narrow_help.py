"""The help of `ros2` on a terminal with few columns."""

from __future__ import annotations

import contextlib
import io
from typing import TYPE_CHECKING

import pytest

from grader.ros2.groups import GROUPS
from grader.ros2.parser import make_parser

if TYPE_CHECKING:
    from collections.abc import Iterator

COMMANDS = [(), *((name, *verb) for name, group in GROUPS.items() for verb in [(), *((v,) for v in group.verbs)])]


def the_help(words: tuple[str, ...]) -> str:
    shown = io.StringIO()
    with contextlib.redirect_stdout(shown), pytest.raises(SystemExit):
        make_parser(words).parse_args([*words, "--help"])
    return shown.getvalue()


def wide_lines(shown: str, width: int) -> Iterator[str]:
    """Yield the lines that are too long although they have more than one word."""
    yield from (line for line in shown.splitlines() if len(line) > width and len(line.split()) > 1)


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_no_word_is_broken_or_cut(monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    wide = the_help(words)
    monkeypatch.setenv("COLUMNS", "40")
    narrow = the_help(words)
    assert list(wide_lines(narrow, 40)) == []
    assert sorted(narrow.split()) == sorted(wide.split())

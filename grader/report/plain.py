"""Make text from a student safe and short enough for a page.

The template escapes all HTML. This module handles the remaining dangers: control characters, invisible characters,
characters that change the direction of text, and very long text.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from grader.common.words import UNSAFE_CATEGORIES

COLOURS = re.compile(r"\x1b\[[0-9;?]*[ -/]*[@-~]")
"""Terminal control sequences."""
LONGEST_LINE = 400
GROWTH = {"&": 5, "<": 4, ">": 4, '"': 5, "'": 5}
"""Maps a character to the size in bytes of the HTML entity that replaces it in a page."""


@dataclass(frozen=True)
class Cut:
    """Lines from the beginning and the end of a text. `left_out` is the number of lines between them."""

    head: tuple[str, ...]
    tail: tuple[str, ...] = ()
    left_out: int = 0


def plain_line(text: str) -> str:
    """Return the text as one line of limited length, without colours, and with "?" for each unsafe character."""
    line = text[: 2 * LONGEST_LINE].rstrip("\r\n")
    if not line.isprintable():
        line = COLOURS.sub("", line).expandtabs(4)
        line = "".join("?" if unicodedata.category(char) in UNSAFE_CATEGORIES else char for char in line)
    return line if len(line) <= LONGEST_LINE and len(text) <= 2 * LONGEST_LINE else line[: LONGEST_LINE - 3] + "..."


def cut(text: str, head_bytes: int, tail_bytes: int) -> Cut:
    """Return as many lines from the beginning and the end of a text as fit into these sizes, as plain text."""
    lines = text.split("\n")
    if lines and not lines[-1].strip():
        lines.pop()
    head = _fitting(lines, head_bytes)
    rest = lines[len(head) :]
    tail = tuple(reversed(_fitting(rest[::-1], tail_bytes)))
    return Cut(head, tail, len(rest) - len(tail))


def _fitting(lines: list[str], room: int) -> tuple[str, ...]:
    kept = []
    for line in lines:
        shown = plain_line(line)
        room -= size(shown) + 1
        if room < 0:
            break
        kept.append(shown)
    return tuple(kept)


def size(text: str) -> int:
    """Return the number of bytes that a text takes up in a page."""
    return len(text.encode("utf-8", "replace")) + sum(text.count(char) * (more - 1) for char, more in GROWTH.items())

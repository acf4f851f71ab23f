"""Helpers for messages: quote untrusted text, format numbers and lists, and find the most similar name."""

from __future__ import annotations

import difflib
import math
import unicodedata
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

UNSAFE_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"})
"""Unicode categories of characters that could move the cursor, colour a terminal, reverse the text or hide it."""


def printable(text: str) -> str:
    """Return the text on one line, with a question mark for each character that could control a terminal."""
    return "".join("?" if unicodedata.category(char) in UNSAFE_CATEGORIES else char for char in _one_line(text))


def _one_line(text: str) -> str:
    return text if text.isprintable() else " ".join(text.split())


def shorten(text: str, limit: int = 60) -> str:
    """Return the text as one printable line of at most `limit` characters."""
    line = printable(text[: 4 * limit])
    return line if len(line) <= limit and len(text) <= 4 * limit else line[: limit - 3].rstrip() + "..."


def nearest(name: str, candidates: Iterable[str], alike: float = 0.6) -> str | None:
    """Return the candidate most similar to `name`, or None if no candidate has a difflib ratio of `alike` or more.

    Only the first 200 characters are compared and returned.
    """
    found = difflib.get_close_matches(name[:200], [candidate[:200] for candidate in candidates], n=1, cutoff=alike)
    return found[0] if found else None


def a_list(items: Sequence[str], last: str = "and", *, most: int = 12) -> str:
    """Return 'a', 'a and b' or 'a, b and c'. If there are N items more than `most`, the list ends with 'N more'."""
    shown = list(items[:most])
    if len(items) > len(shown):
        shown.append(f"{len(items) - len(shown)} more")
    if len(shown) < 2:
        return "".join(shown)
    return f"{', '.join(shown[:-1])} {last} {shown[-1]}"


def number(value: float, unlike: float | None = None) -> str:
    """Return the number with up to four significant digits, or with all if it would otherwise look equal to `unlike`.

    NaN and infinity are spelled out.
    """
    if math.isnan(value):
        return "NaN (not a number)"
    if math.isinf(value):
        return "infinity" if value > 0 else "minus infinity"
    text = f"{value:.4g}"
    if unlike is not None and value != unlike and float(text) == unlike:
        text = repr(value)
    return text if any(char in text for char in ".e") else f"{text}.0"


def count(amount: int, thing: str) -> str:
    """Return '1 command' or '20 commands'."""
    return f"{amount} {thing}" if amount == 1 else f"{amount} {thing}s"


def line_at(data: bytes, position: int) -> int:
    """Return the number of the line that contains the byte at this position. The first line has the number 1."""
    return data.count(b"\n", 0, position) + 1

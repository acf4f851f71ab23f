"""Explain an IndentationError: the line that Python reports is often not the line that must be changed."""

from __future__ import annotations

import re
import tokenize
from collections import Counter
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import count
from grader.submission.tokens import tokens
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.submission.code import Unreadable

UNEVEN = re.compile(r"unexpected indent|unindent does not match")
DECORATOR = re.compile(r"[ \t]*@\w")
NOT_CODE = frozenset({tokenize.COMMENT, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING})


def why_indented(file: str, unreadable: Unreadable, data: bytes) -> Cause | None:
    """Return the cause of an IndentationError if the lines around it show which line must change, else None."""
    lines = data.decode("utf-8", "replace").splitlines()
    if not unreadable.line or unreadable.line > len(lines):
        return None
    here = unreadable.line
    before = [number for number in _statements(data) if number < here]
    if "unexpected unindent" in unreadable.message and before and DECORATOR.match(lines[before[-1] - 1]):
        text = f"The decorator on line {before[-1]} belongs to line {here}, so both must start at the same column."
        return Cause("indentation", text, Where(file, here))
    if not UNEVEN.search(unreadable.message) or not before:
        return None
    widths = {number: _spaces(lines[number - 1]) for number in (*before, here)}
    first = before[-1]
    begins_block = len(before) > 1 and (widths[before[-2]] or 0) < (widths[first] or 0)
    usual = Counter(width for number, width in widths.items() if number not in (first, here))
    own, next_ = widths[first], widths[here]
    if own is None or next_ is None or not begins_block or usual[own] >= usual[next_]:
        return None
    text = (
        f"Line {first} starts with {count(own, 'space')}, and line {here} with {next_}. "
        "All lines of a block must start at the same column."
    )
    return Cause("indentation", text, Where(file, first))


def _spaces(line: str) -> int | None:
    """Return the number of spaces at the beginning of the line, or None if a tab is before or after them."""
    rest = line.lstrip(" ")
    return None if rest.startswith("\t") else len(line) - len(rest)


def _statements(data: bytes) -> list[int]:
    """Return the line numbers of the statements, up to the line at which Python's tokenizer fails."""
    found: list[int] = []
    begins = True
    for token in tokens(data):
        if begins and token.type not in NOT_CODE:
            found.append(token.start[0])
            begins = False
        begins = begins or token.type == tokenize.NEWLINE
    return found

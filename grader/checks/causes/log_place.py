"""Find the call that wrote a log line."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where

LEVELS = ("info", "warning", "warn", "error", "fatal")
"""The methods of a logger whose lines are shown even without --log-level debug."""
PLACEHOLDER = re.compile(r"%(?:\([^)]*\))?[-+# .\d]*[a-zA-Z%]|\{[^{}]*\}")
"""Matches a place in a string where the operator % or the method format puts a value."""


def log_place(evidence: Evidence, line: str) -> Where | None:
    """Return the place of a call that can have written this line.

    If there is none, return the place of any call to a logger, or else the node's file, or None.
    """
    calls = (call for level in LEVELS for call in evidence.code.calls(level))
    for call in calls:
        message = call.argument(0, "message")
        if message is not None and _can_be(message, line):
            return call.where
    return evidence.place(*LEVELS)


def _can_be(message: ast.expr, line: str) -> bool:
    """Return whether the strings in the expression, with any values between them, can form this line."""
    pieces = [piece for piece in _pieces(message) if piece != ""]
    at = 0
    for number, piece in enumerate(pieces):
        if piece is None:
            continue
        free = number > 0 and pieces[number - 1] is None
        found = line.rfind(piece, at) if free and number == len(pieces) - 1 else line.find(piece, at)
        if found < 0 or (found != at and not free):
            return False
        at = found + len(piece)
    return at == len(line) or (bool(pieces) and pieces[-1] is None)


def _pieces(message: ast.expr) -> Iterator[str | None]:
    """Yield the strings that the expression consists of, and None for a value that is not known."""
    if isinstance(message, ast.JoinedStr):
        for value in message.values:
            yield from _pieces(value)
    elif isinstance(message, ast.BinOp) and isinstance(message.op, ast.Add):
        yield from _pieces(message.left)
        yield from _pieces(message.right)
    elif (template := _template(message)) is not None:
        for number, text in enumerate(PLACEHOLDER.split(template)):
            yield from ((None, text) if number else (text,))
    else:
        yield message.value if isinstance(message, ast.Constant) and isinstance(message.value, str) else None


def _template(message: ast.expr) -> str | None:
    """Return the string on which the operator % or the method format is used, or None."""
    if isinstance(message, ast.BinOp) and isinstance(message.op, ast.Mod):
        left = message.left
    elif isinstance(message, ast.Call) and isinstance(message.func, ast.Attribute) and message.func.attr == "format":
        left = message.func.value
    else:
        return None
    return left.value if isinstance(left, ast.Constant) and isinstance(left.value, str) else None

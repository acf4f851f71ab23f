"""A comma after a value, as in `self.period = 0.5,`: the comma makes a tuple with one value."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene

REFUSED = re.compile(r"\btuple\b|The '\w+' field must be of type|incompatible function arguments")
"""Matches messages about a tuple, and messages that do not contain the type of the rejected value."""


def trailing_comma(scene: CrashScene) -> Cause | None:
    """Return the cause if the line of the crash uses a variable that is a tuple only because of a comma, else None."""
    if not REFUSED.search(scene.crash.message):
        return None
    used = {dotted(node) for node in scene.on_line if isinstance(node, ast.Name | ast.Attribute)} - {None}
    for name, value in _assignments(scene):
        if name not in used or not isinstance(value, ast.Tuple) or len(value.elts) != 1:
            continue
        line = _line(scene, value.end_lineno)
        end = value.end_col_offset or 0
        if line[end - 1 : end] != b",":  # With parentheses, the student wants a tuple.
            continue
        text = f"The comma after the value on line {value.end_lineno} makes {shorten(name)} a tuple with one value."
        place = scene.at(value.end_lineno)
        without = line[: end - 1] + line[end:]
        return Cause("trailing-comma", text, place).fixed_by(at(place, line.decode(), without.decode()))
    return None


def _assignments(scene: CrashScene) -> Iterator[tuple[str, ast.expr]]:
    """Yield each name or attribute that is in scope on the line of the crash, with a value that is assigned to it."""
    for node in scene.nodes:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        in_class = scene.class_around(node) is not None
        visible = scene.function_around(node) in (None, scene.function)
        for name in map(dotted, node.targets if isinstance(node, ast.Assign) else [node.target]):
            if name is not None and (visible or "." in name):
                yield (f"self.{name}" if in_class else name), node.value


def _line(scene: CrashScene, number: int | None) -> bytes:
    """Return the line with this number (from 1) as bytes, since the columns in a syntax tree are counted in bytes."""
    file = scene.module.file if scene.module is not None else ""
    lines = scene.evidence.submission.files.get(file, b"").splitlines()
    return lines[number - 1] if number is not None and number <= len(lines) else b""

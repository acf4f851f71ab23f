"""A comma in place of a dot, as in `self,counter`, `rclpy,spin(node)` or `msg,linear.x = 2.0`."""

from __future__ import annotations

import ast
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene


def comma_for_dot(scene: CrashScene, undefined: str = "") -> Cause | None:
    """Return the cause if the line of the crash has a comma in place of a dot, else None.

    `undefined` is the name that a NameError reports. If it is empty, the value after the comma may begin with any name.
    """
    for left, right in _neighbours(scene):
        owner, name = ast.unparse(left), _first_name(right)
        if name is None or (undefined and name != undefined):
            continue
        text = f"A comma separates {shorten(owner)} from {shorten(name)}. Write a dot: {shorten(f'{owner}.{name}')}."
        space = " " * (right.col_offset - (left.end_col_offset or 0) - 1)
        fix = at(scene.at(left), f"{owner},{space}{name}", f"{owner}.{name}")
        return Cause("comma-for-dot", text, scene.at(left)).fixed_by(fix)
    return None


def _neighbours(scene: CrashScene) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the values before and after each comma that may be a typing mistake for a dot."""
    for node in scene.on_line:
        if isinstance(node, ast.Expr | ast.FormattedValue) and isinstance(node.value, ast.Tuple):
            yield from _pairs(node.value.elts)
        elif isinstance(node, ast.Assign):
            for each in (*node.targets, node.value):
                if isinstance(each, ast.Tuple):
                    yield from (pair for pair in _pairs(each.elts) if _belongs(scene, *pair))
        elif isinstance(node, ast.Call):
            # Only without a space: `f(self, counter)` passes two values, and one of them may be undefined.
            yield from (pair for pair in _pairs(node.args) if _touch(*pair) and _belongs(scene, *pair))


def _pairs(values: list[ast.expr]) -> Iterator[tuple[ast.expr, ast.expr]]:
    for before, after in pairwise(values):
        while isinstance(before, ast.BinOp | ast.UnaryOp):
            before = before.right if isinstance(before, ast.BinOp) else before.operand
        if before.end_lineno == after.lineno and (isinstance(before, ast.Call) or dotted(before) is not None):
            yield before, after


def _touch(left: ast.expr, right: ast.expr) -> bool:
    """Return whether there is only a comma, and no space, between two values."""
    return left.end_col_offset == right.col_offset - 1


def _belongs(scene: CrashScene, left: ast.expr, right: ast.expr) -> bool:
    """Return whether the first name of `right` is likely to be an attribute of `left`."""
    owner = dotted(left)
    if owner == "self" or (isinstance(right, ast.Attribute) and isinstance(right.ctx, ast.Store)):
        return True
    imported = {
        alias.asname or alias.name for node in scene.nodes if isinstance(node, ast.Import) for alias in node.names
    }
    return owner in imported or any(
        isinstance(node, ast.Attribute)
        and node.attr == _first_name(right)
        and (dotted(node.value) or "").rpartition(".")[2] == (owner or ".").rpartition(".")[2]
        for node in scene.nodes
    )


def _first_name(node: ast.expr) -> str | None:
    """Return the name at the beginning of an expression, or None."""
    while not isinstance(node, ast.Name):
        match node:
            case ast.Attribute(value=inner) | ast.Subscript(value=inner) | ast.Call(func=inner):
                node = inner
            case ast.BinOp(left=inner) | ast.Compare(left=inner):
                node = inner
            case _:
                return None
    return node.id

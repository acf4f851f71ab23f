"""Explain a TypeError in a computation with None, such as `None + 1.0`."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import a_list, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

WITH_NONE = re.compile(
    r"unsupported operand type\(s\) for .*'NoneType'|bad operand type for unary .*'NoneType'|"
    r"not supported between instances of .*'NoneType'"
)
"""Matches Python's messages about an operator with None as an operand."""


def why_none(scene: CrashScene) -> Cause | None:
    """Return the cause if an operand is None. If the exception has another reason, return None."""
    if not WITH_NONE.search(scene.crash.message):
        return None
    names = dict.fromkeys(name for node in scene.on_line for name in map(dotted, _sides(node)) if name)
    empty = [shorten(name) for name in names if _is_none_at_first(scene, name)]
    if len(empty) == 1:
        text = f"{empty[0]} is None until it gets a value. Check for None before you compute with it."
        return Cause("none-before-message", text)
    if empty:
        text = f"{a_list(empty)} are None until they get a value. Check for None before you compute with them."
        return Cause("none-before-message", text)
    return Cause("crash", "An operand is None, which is not a number.")


def _sides(node: ast.AST) -> list[ast.expr]:
    if isinstance(node, ast.BinOp):
        return [node.left, node.right]
    if isinstance(node, ast.Compare):
        return [node.left, *node.comparators]
    if isinstance(node, ast.AugAssign):
        return [node.target, node.value]
    return [node.operand] if isinstance(node, ast.UnaryOp) else []


def _is_none_at_first(scene: CrashScene, name: str) -> bool:
    """Return whether one line of the file assigns None to this name, and another line assigns another value."""
    values = [node.value for node in scene.nodes if isinstance(node, ast.Assign) and name in map(dotted, node.targets)]
    none = [isinstance(value, ast.Constant) and value.value is None for value in values]
    return any(none) and not all(none)

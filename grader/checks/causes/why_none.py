"""Explain a TypeError because a value is None, as in `None + 1.0` or `for pose in None`."""

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
GIVEN_NONE = re.compile(
    r"'NoneType' object is not (?:iterable|subscriptable)|must be (?:a )?real number, not '?NoneType"
    r"|cannot unpack non-iterable NoneType"
)
"""Matches Python's messages about None in place of a number, a list or another collection."""


def why_none(scene: CrashScene) -> Cause | None:
    """Return the cause if an operand or an argument is None. If the exception has another reason, return None."""
    of_operator = WITH_NONE.search(scene.crash.message) is not None
    if not of_operator and not GIVEN_NONE.search(scene.crash.message):
        return None
    values = [value for node in scene.on_line for value in (_sides(node) if of_operator else _arguments(node))]
    names = dict.fromkeys(name for name in map(dotted, values) if name)
    empty = [shorten(name) for name in names if _is_none_at_first(scene, name)]
    if len(empty) == 1:
        text = f"{empty[0]} is None until it gets a value. Check for None before you compute with it."
        return Cause("none-before-message", text)
    if empty:
        text = f"{a_list(empty)} are None until they get a value. Check for None before you compute with them."
        return Cause("none-before-message", text)
    if any(isinstance(each, ast.Attribute) and each.attr == "value" for each in values) and _reads_parameter(scene):
        text = "A parameter that is declared without a default value is None. Give declare_parameter a default value."
        return Cause("none-before-message", text)
    if of_operator:
        return Cause("crash", "An operand is None, which is not a number.")
    return Cause("crash", "A value in this line is None. A function without a return statement returns None.")


def _reads_parameter(scene: CrashScene) -> bool:
    """Return whether the line reads a parameter, and the file declares one without a default value."""
    declared = [node for node in scene.nodes if isinstance(node, ast.Call) and len(node.args) + len(node.keywords) == 1]
    return bool(scene.calls_on_line("get_parameter")) and any(
        getattr(node.func, "attr", "") == "declare_parameter" for node in declared
    )


def _arguments(node: ast.AST) -> list[ast.expr]:
    if isinstance(node, ast.Call):
        return list(node.args)
    if isinstance(node, ast.Subscript | ast.Starred):
        return [node.value]
    return [node.value] if isinstance(node, ast.Assign) else []


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

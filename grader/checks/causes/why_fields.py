"""Why a message's field refused a value: the assertions of ROS 2's generated messages."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.causes.cause import Cause
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import Scene

FIELD = re.compile(r"The '(?P<field>\w+)' field must be (?:of|a sub message of) type '(?P<type>\w+)'")
FLOAT = ("float", "double")
READS = ("input", "get", "str", "format", "getenv")
"""Functions that give a text."""


def why_field(scene: Scene) -> Cause | None:
    """An int, a text or a numpy number in a float field; a number where a message belongs."""
    match = FIELD.search(scene.crash.message)
    if match is None:
        if "Invalid arguments passed to constructor" in scene.crash.message:
            return Cause("message-arguments", "A message is made empty, and its fields are set after that, one by one.")
        return None
    field, wanted = match["field"], match["type"]
    if wanted not in FLOAT:
        return Cause("field-type", f"The field {field} is itself a {wanted}, with parts of its own: set those.")
    value = _assigned(scene, field)
    return _why_no_float(field, value and _resolved(scene, value))


def _why_no_float(field: str, value: ast.expr | None) -> Cause:
    if isinstance(value, ast.UnaryOp):
        value = value.operand
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return Cause("text-for-number", f"The field {field} is a float; in quotation marks it is a text.")
    if isinstance(value, ast.Constant) and isinstance(value.value, bool):
        return Cause("field-type", f"The field {field} is a float, and neither true nor false.")
    if isinstance(value, ast.Constant) and isinstance(value.value, int):
        return Cause("int-for-float", f"The field {field} is a float: write the number with a decimal point.")
    names = [dotted(call.func) or "" for call in ast.walk(value) if isinstance(call, ast.Call)] if value else []
    if any(name.startswith(("np.", "numpy.")) for name in names):
        return Cause(
            "numpy-for-float",
            f"The field {field} wants Python's own float; numpy has others. float(...) makes one of it.",
        )
    if names and names[0].rpartition(".")[2] in READS:
        return Cause(
            "text-for-number",
            f"The field {field} is a float, and what is read is a text. float(...) makes one of it.",
        )
    if names and names[0] in ("int", "round", "len"):
        return Cause("int-for-float", f"The field {field} is a float, and {names[0]}(...) gives a whole number.")
    return Cause("field-type", f"The field {field} is a float, and the value is of another type. float(...) makes one.")


def _assigned(scene: Scene, field: str) -> ast.expr | None:
    for node in scene.on_line:
        if isinstance(node, ast.Assign) and any(
            isinstance(each, ast.Attribute) and each.attr == field for each in node.targets
        ):
            return node.value
        if isinstance(node, ast.keyword) and node.arg == field:
            return node.value
    return None


def _resolved(scene: Scene, value: ast.expr) -> ast.expr:
    """The expression, which stands in the scene, or the one that its name stands for."""
    assert scene.module is not None
    return scene.module.names.get(dotted(value) or "") or value

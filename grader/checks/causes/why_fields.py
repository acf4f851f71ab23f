"""Explain why a message field rejected a value, according to the assertion in the ROS 2 message class."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene
    from grader.checks.edit import Edit

FIELD = re.compile(r"The '(?P<field>\w+)' field must be (?P<inner>of|a sub message of) type '(?P<type>\w+)'")
RANGE = re.compile(r"The '(?P<field>\w+)' field must be an (?:un)?signed integer in \[(?P<low>-?\d+), (?P<high>\d+)\]")
LIST = re.compile(r"The '(?P<field>\w+)' field must be a set or sequence")
ELEMENT = re.compile(r"each value of type '(?P<type>\w+)'")
FLOAT = ("float", "double")
KINDS = {"int": "a whole number", "str": "a string", "bool": "True or False"}
"""Maps the Python type of a field to a phrase for the values of the field."""
COLLECTIONS: dict[object, str] = {
    ast.Tuple: "a comma makes a tuple. Write a dot, not a comma, in decimal numbers.",
    ast.List: "the value is a list. Assign one number.",
    ast.Dict: "the value is a dictionary. Assign one number.",
}
"""Maps a kind of expression to the end of the sentence about its value."""
READS = ("input", "str", "format", "getenv")
"""Functions that return a string."""


def why_field(scene: CrashScene) -> Cause | None:
    """Return the cause of a wrong value, such as an int in a float field, or of an unknown field, else None."""
    match = FIELD.search(scene.crash.message)
    if match is None:
        limits = RANGE.search(scene.crash.message)
        if limits is not None:
            text = f"The field {limits['field']} is a whole number from {limits['low']} to {limits['high']}."
            return Cause("field-type", text)
        many = LIST.search(scene.crash.message)
        if many is not None:
            text = f"The field {many['field']} is a list. Write square brackets, even for one element."
            element = ELEMENT.search(scene.crash.message)
            if element is not None and isinstance(assigned(scene, many["field"]), ast.List):
                text = f"Each element of the list {many['field']} must be an object of the class {element['type']}."
            return Cause("field-type", text)
        if "Invalid arguments passed to constructor" in scene.crash.message:
            return _no_such_field(scene)
        return None
    field, wanted = match["field"], match["type"]
    value = assigned(scene, field)
    resolved = value and _resolved(scene, value)
    if match["inner"] != "of":
        return Cause("field-type", f"The field {field} has the type {wanted}, with its own fields. Set these fields.")
    if wanted not in FLOAT:
        point = wanted == "int" and isinstance(resolved, ast.Constant) and isinstance(resolved.value, float)
        more = ": write it without a decimal point" if point else ""
        return Cause("field-type", f"The value of the field {field} must be {KINDS.get(wanted, wanted)}{more}.")
    cause = _whole_parameter(scene, field, resolved) or why_no_float(field, resolved)
    cause = cause or Cause(
        "field-type", f"The field {field} is a float, but the value has another type. Convert it with float(...)."
    )
    if isinstance(resolved, ast.Constant) and resolved is value:
        return cause.fixed_by(_as_float(scene, resolved))
    return cause


def _no_such_field(scene: CrashScene) -> Cause:
    """Return the cause for a message that was created with an argument that is not one of its fields."""
    names = scene.crash.message.rpartition(": ")[2].rstrip(".")
    text = "Create the message without arguments, then set its fields one by one."
    made = [node for node in scene.on_line if isinstance(node, ast.Call)]
    calls = [call for call in made if names in [keyword.arg for keyword in call.keywords]]
    of = (dotted(calls[0].func) or "").rpartition(".")[2] if calls else ""
    if calls and of not in ros_names.FIELDS:
        text = f"The message has no field {shorten(names)}. Check the name letter by letter."
    return Cause("message-arguments", text)


def _as_float(scene: CrashScene, value: ast.Constant) -> tuple[Edit, ...]:
    try:
        number = float(value.value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return ()
    quoted = f'"{value.value}"' if isinstance(value.value, str) else str(value.value)
    return at(scene.at(value), quoted, str(number))


def why_no_float(field: str, value: ast.expr | None) -> Cause | None:
    """Return the cause if the expression shows why its value is not a float, else None."""
    shown = ast.unparse(value) if value is not None else ""
    if isinstance(value, ast.UnaryOp):
        value = value.operand
    if isinstance(value, ast.Constant | ast.JoinedStr):
        known = _why_constant(field, value, shown)
        if known is not None:
            return known
    if type(value) in COLLECTIONS:
        return Cause("field-type", f"The field {field} is a float, but {COLLECTIONS[type(value)]}")
    names = [dotted(call.func) or "" for call in ast.walk(value) if isinstance(call, ast.Call)] if value else []
    if any(name.startswith(("np.", "numpy.")) for name in names):
        return Cause(
            "numpy-for-float",
            f"The field {field} needs a Python float, not a NumPy value. Convert it with float(...).",
        )
    if isinstance(value, ast.Call) and getattr(value.func, "attr", "") == "get_parameter_value":
        text = f"The field {field} is a float, but this is a ParameterValue. The number is in its field double_value."
        return Cause("field-type", text)
    if isinstance(value, ast.Call) and names[0].endswith(("get_parameter", "declare_parameter")):
        text = (
            f"The field {field} is a float, but this is the parameter itself. The value of the parameter is in .value."
        )
        return Cause("field-type", text)
    if names and (names[0].rpartition(".")[2] in READS or names[0].endswith("environ.get")):
        return Cause(
            "string-for-number",
            f"The field {field} is a float, but the value is a string. Convert it with float(...).",
        )
    if names and names[0] in ("int", "round", "len"):
        return Cause("int-for-float", f"The field {field} is a float, but {names[0]}(...) returns an integer.")
    return None


def _whole_parameter(scene: CrashScene, field: str, value: ast.expr | None) -> Cause | None:
    """Return the cause if the value comes from a parameter whose default value is an integer, else None."""
    calls = [node for node in ast.walk(value) if isinstance(node, ast.Call)] if value is not None else []
    read = {name for call in calls if (name := _parameter(call, "get_parameter")) is not None}
    for node in scene.nodes:
        if isinstance(node, ast.Call) and (name := _parameter(node, "declare_parameter")) in read:
            default = node.args[1] if len(node.args) > 1 else None
            if isinstance(default, ast.Constant) and type(default.value) is int:
                text = (
                    f"The field {field} is a float, but the default value of the parameter {shorten(name or '')} is "
                    f"the integer {default.value}. Write {float(default.value)}."
                )
                fix = at(scene.at(default), str(default.value), str(float(default.value)))
                return Cause("int-for-float", text, scene.at(default)).fixed_by(fix)
    return None


def _parameter(call: ast.Call, method: str) -> str | None:
    """Return the name of the parameter if the call is a call to this method of a node, else None."""
    name = call.args[0] if call.args and (dotted(call.func) or "").endswith(f".{method}") else None
    return name.value if isinstance(name, ast.Constant) and isinstance(name.value, str) else None


def _why_constant(field: str, value: ast.Constant | ast.JoinedStr, shown: str) -> Cause | None:
    """Return the cause if a string, a bool, an integer or None is written where a float belongs, else None."""
    if isinstance(value, ast.JoinedStr):
        return Cause("string-for-number", f"The field {field} is a float, but an f-string is a string.")
    if isinstance(value.value, str):
        return Cause("string-for-number", f"The field {field} is a float. In quotation marks, a number is a string.")
    if isinstance(value.value, bool):
        return Cause("field-type", f"The field {field} is a float, not True or False.")
    if isinstance(value.value, int):
        text = (
            f"The field {field} is a float, but {shorten(shown)} is an integer. Write the number with a decimal point."
        )
        return Cause("int-for-float", text)
    if value.value is None:
        return Cause("field-type", f"The field {field} is a float, and None is not a number.")
    return None


def assigned(scene: CrashScene, field: str) -> ast.expr | None:
    """Return the expression that the line of the exception assigns to this field, or None."""
    for node in scene.on_line:
        if isinstance(node, ast.Assign) and any(
            isinstance(each, ast.Attribute) and each.attr == field for each in node.targets
        ):
            return node.value
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple):
            pairs = (pair for target in node.targets for pair in _pairs(target, node.value))
            given = next((value for each, value in pairs if getattr(each, "attr", "") == field), None)
            if given is not None:
                return given
        # A call can be longer than the line of the exception, which is the line on which the call begins.
        keywords = node.keywords if isinstance(node, ast.Call) else []
        given = next((each.value for each in keywords if each.arg == field), None)
        if given is not None:
            return given
    return None


def _pairs(target: ast.expr, values: ast.Tuple) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the targets and values of an assignment such as `msg.x, msg.y = 1, 2`."""
    if isinstance(target, ast.Tuple) and len(target.elts) == len(values.elts):
        yield from zip(target.elts, values.elts, strict=True)


def _resolved(scene: CrashScene, value: ast.expr) -> ast.expr:
    """Return the expression or, if the expression is a name, the value that is assigned to this name.

    Call this function only if `scene.module` is not None.
    """
    assert scene.module is not None
    return scene.module.names.get(dotted(value) or "") or value

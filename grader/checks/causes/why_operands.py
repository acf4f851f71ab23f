"""Explain why an operator does not support the types of two values, for example a list and a number."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.comma_for_dot import comma_for_dot
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

OPERANDS = re.compile(r"unsupported operand type\(s\) for (?P<operator>[^:]+): '(?P<left>\w+)' and '(?P<right>\w+)'")
CONCATENATED = re.compile(r"can only concatenate (?P<left>\w+) \(not \"(?P<right>\w+)\"\) to \w+")
CARET = re.compile(r"unsupported operand type\(s\) for \^=?: |ufunc 'bitwise_xor' not supported")
MULTIPLIED = "can't multiply sequence by non-int of type 'float'"
COMPARED = re.compile(r"not supported between instances of '(\w+)' and '(\w+)'")
UNPACKED = re.compile(r"cannot unpack non-iterable (?P<type>\w+) object")
JOINED = re.compile(r"sequence item \d+: expected str instance, (?P<type>\w+_(?:Response|Request)) found")
QUOTES = "'\""
NUMBERS = frozenset({"int", "float", "float64"})


def why_operands(scene: CrashScene) -> Cause | None:
    """Return the cause of a TypeError about an operator whose two operands do not fit together, else None."""
    if CARET.search(scene.crash.message):
        return Cause("caret-for-power", "In Python, ^ is not a power. Write x**2 for the square of x.")
    if (item := JOINED.search(scene.crash.message)) is not None:
        text = f"join needs strings, but an item of this list is an object of the type {shorten(item['type'])}."
        return Cause("crash", text)
    found = OPERANDS.search(scene.crash.message) or CONCATENATED.search(scene.crash.message)
    if found is None:
        return _other_values(scene, scene.crash.message)
    left, right = found["left"], found["right"]
    types = {left, right}
    adds = "operator" not in found.groupdict() or found["operator"].startswith("+")
    if adds and "str" in types and types & NUMBERS:
        return Cause(
            "string-and-number", "A string and a number cannot be added. Use an f-string to put a number into a string."
        )
    if "list" in types and types & NUMBERS:
        text = "A list is not an array: Python cannot compute with a whole list. `np.array` turns a list into an array."
        return Cause("list-for-array", text)
    if "property" in types:
        text = "A class is used in place of a message: its fields have no values. Check upper and lower case in names."
        return Cause("class-for-object", text)
    if "ParameterValue" in types:
        text = "get_parameter_value returns a ParameterValue, which is a message. The field double_value has the float."
        return Cause("parameter-itself", text)
    if "str" in types and types & NUMBERS and (quoted := _default_in_quotes(scene)) is not None:
        return quoted
    if (comma := comma_for_dot(scene)) is not None:
        return comma
    return Cause("crash", f"This operator cannot combine a value of type {left} with a value of type {right}.")


def _other_values(scene: CrashScene, text: str) -> Cause | None:
    """Return the cause if a value cannot be multiplied, compared, unpacked or used in a loop, else None."""
    if MULTIPLIED in text:
        text = "A string or a list cannot be multiplied by a number with a decimal point."
        return _default_in_quotes(scene) or Cause("crash", text)
    if (compared := COMPARED.search(text)) is not None and "str" in compared.groups():
        text = "A number cannot be compared with a string. float(...) turns a string such as '2.0' into a number."
        return Cause("crash", text) if NUMBERS & set(compared.groups()) else None
    if (unpacked := UNPACKED.search(text)) is not None:
        text = f"This line assigns to several names, but there is only one value, of type {unpacked['type']}."
        return comma_for_dot(scene) or Cause("crash", text)
    if "'int' object is not iterable" in text and any(_counts(node, scene.line) for node in scene.nodes):
        return Cause("crash", "A for loop cannot go through a number. To repeat 5 times, write range(5).")
    return None


def _counts(node: ast.AST, line: int) -> bool:
    """Return whether this is a for statement on the line."""
    return isinstance(node, ast.For) and node.lineno == line


def _default_in_quotes(scene: CrashScene) -> Cause | None:
    """Return the cause if the default value of a parameter is a number in quotation marks, else None."""
    for node in scene.nodes:
        declares = isinstance(node, ast.Call) and (dotted(node.func) or "").endswith("declare_parameter")
        if isinstance(node, ast.Call) and declares and len(node.args) > 1:
            name, default = node.args[:2]
            if isinstance(default, ast.Constant) and isinstance(default.value, str) and _is_number(default.value):
                text = (
                    f"The default value of the parameter {shorten(ast.unparse(name).strip(QUOTES))} is a string. "
                    f"Write {shorten(default.value)} without quotation marks."
                )
                return Cause("parameter-type", text, scene.at(default))
    return None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True

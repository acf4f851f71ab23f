"""Explain why an operator does not support the types of two values, for example a list and a number."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.comma_for_dot import comma_for_dot

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

OPERANDS = re.compile(r"unsupported operand type\(s\) for (?P<operator>[^:]+): '(?P<left>\w+)' and '(?P<right>\w+)'")
CONCATENATED = re.compile(r"can only concatenate (?P<left>\w+) \(not \"(?P<right>\w+)\"\) to \w+")
NUMBERS = frozenset({"int", "float", "float64"})


def why_operands(scene: CrashScene) -> Cause | None:
    """Return the cause of a TypeError that an operator raised, or None for any other TypeError."""
    found = OPERANDS.search(scene.crash.message) or CONCATENATED.search(scene.crash.message)
    if found is None:
        return None
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
    if (comma := comma_for_dot(scene)) is not None:
        return comma
    return Cause("crash", f"This operator cannot combine a value of type {left} with a value of type {right}.")

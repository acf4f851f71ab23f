"""Explain why one of the student's functions failed: its caller passed a wrong argument, or swapped two arguments.

The traceback ends inside the function, but the line that must change is the call.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_calls import RIGHT_ORDER, kind_of
from grader.checks.causes.why_fields import FIELD, FLOAT, assigned, why_no_float
from grader.common.words import a_list, shorten
from grader.submission.constants import written
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene, Function
    from grader.submission.code import Module

OF_A_VALUE = re.compile(r"'(?:str|int|float|bool)' object has no attribute '(?P<name>\w+)'")
NUMBERS = re.compile(r"period|sec|rate|time|dt|interval|delay|queue|qos|depth", re.IGNORECASE)
"""Matches names that learners give to a parameter whose value is the number for create_timer or create_publisher."""


@dataclass(frozen=True)
class Call:
    """A call to the function that raised the exception.

    `parameters` are the names of the function's parameters, except self. `arguments` maps these names to the arguments
    of the call. `module` contains the call.
    """

    function: Function
    parameters: tuple[str, ...]
    arguments: dict[str, ast.expr]
    module: Module
    line: int

    @property
    def in_wrong_order(self) -> Cause:
        """The cause if two arguments of the call are swapped."""
        order = a_list([shorten(each) for each in self.parameters])
        text = f"{self.function.name} takes its arguments in this order: {order}."
        return Cause("arguments-swapped", text, Where(self.module.file, self.line))

    def passed(self, node: ast.expr) -> ast.expr | None:
        """Return the expression that the call passes for this parameter, or None if it passes none."""
        given = self.arguments.get(node.id) if isinstance(node, ast.Name) else None
        return written(given, self.module.names)


def why_passed(scene: CrashScene) -> Cause | None:
    """Return the cause if the caller of the function that raised the exception passed a wrong argument, else None."""
    explain = {"AssertionError": _field, "AttributeError": _attribute, "TypeError": _maker}.get(scene.crash.error)
    call = _call(scene) if explain is not None else None
    return explain(scene, call) if explain is not None and call is not None else None


def _call(scene: CrashScene) -> Call | None:
    """Return the call to the function that crashed if the caller's line has exactly one such call, else None."""
    function = scene.function
    line = next(iter(scene.crash.callers), None)
    module = scene.module_of(line.file) if line is not None else None
    if function is None or line is None or module is None:
        return None
    called = {function.name, *(each.name for each in scene.classes if function in each.body and _creates(function))}
    calls = [
        node
        for node in module.nodes
        if isinstance(node, ast.Call)
        and node.lineno <= (line.line or 0) <= (node.end_lineno or 0)
        and (getattr(node.func, "attr", "") or getattr(node.func, "id", "")) in called
    ]
    if len(calls) != 1 or any(isinstance(each, ast.Starred) for each in calls[0].args):
        return None
    names = [each.arg for each in (*function.args.posonlyargs, *function.args.args)]
    names = names[1:] if names[:1] == ["self"] else names
    arguments = dict(zip(names, calls[0].args, strict=False))
    arguments |= {each.arg: each.value for each in calls[0].keywords if each.arg is not None}
    return Call(function, tuple(names), arguments, module, calls[0].lineno)


def _creates(function: Function) -> bool:
    return function.name == "__init__"


def _field(scene: CrashScene, call: Call) -> Cause | None:
    """Return the cause if an argument that is not a float was assigned to a float field, else None."""
    match = FIELD.search(scene.crash.message)
    value = assigned(scene, match["field"]) if match is not None and match["type"] in FLOAT else None
    given = call.passed(value) if value is not None else None
    if match is None or given is None:
        return None
    others = [kind_of(each, scene) for name, each in call.arguments.items() if name != getattr(value, "id", "")]
    if "number" in others and _is_no_number(given, scene):
        return call.in_wrong_order
    cause = why_no_float(match["field"], given)
    return cause and cause.at(Where(call.module.file, given.lineno))


def _is_no_number(given: ast.expr, scene: CrashScene) -> bool:
    """Return whether the expression is not meant as a number: a method, a class, an object, or a string of words."""
    if isinstance(given, ast.Call):
        return kind_of(given.func, scene) == "class"
    if isinstance(given, ast.Constant):
        return isinstance(given.value, str) and not re.fullmatch(r"\s*[-+]?[\d.,]+\s*", given.value)
    return kind_of(given, scene) in ("method", "class")


def _attribute(scene: CrashScene, call: Call) -> Cause | None:
    """Return the cause if a number or string and an object are passed in the wrong order, else None."""
    match = OF_A_VALUE.search(scene.crash.message)
    for node in scene.on_line:
        if match is not None and isinstance(node, ast.Attribute) and node.attr == match["name"]:
            others = [written(each, call.module.names) for each in call.arguments.values()]
            objects = [each for each in others if isinstance(each, ast.Name | ast.Attribute | ast.Call)]
            if isinstance(call.passed(node.value), ast.Constant | ast.UnaryOp) and objects:
                return call.in_wrong_order
    return None


def _maker(scene: CrashScene, call: Call) -> Cause | None:
    """Return the cause if the function passes swapped arguments on to create_timer or a similar method, else None."""
    for name, wanted in RIGHT_ORDER.items():
        for made in scene.calls_on_line(name):
            behind = [call.passed(each) for each in made.args]
            pairs = zip(behind, made.args, strict=True)
            kinds = [kind_of(each if given is None else given, scene) for given, each in pairs]
            if sum(given is not None for given in behind) < 2 or kinds == wanted or sorted(kinds) != sorted(wanted):
                continue
            names = [getattr(each, "id", "") for each in made.args]
            numbers = [at for at, each in enumerate(names) if NUMBERS.search(each)]
            inside = bool(numbers) and numbers[0] != wanted.index("number")
            return None if inside else call.in_wrong_order
    return None

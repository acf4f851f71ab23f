"""Explain exceptions about parameters: old names, wrong callbacks and ranges, and parameters without a value."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import attributes_set
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

OLD, NEW, BEFORE = "set_parameters_callback", "add_on_set_parameters_callback", "add_pre_set_parameters_callback"
WITHOUT_VALUE = re.compile(r"The parameter '(?P<name>[^']+)' is not initialized")
OF_RANGE = re.compile(r"The '(?:from_value|to_value|step)' field must be of type 'int'")
TYPES = re.compile(r"expected 'Type\.(?P<wanted>\w+)' got 'Type\.(?P<given>\w+)'")
STORE = "_parameters"
"""The attribute in which rclpy keeps the parameters of a node."""


def why_parameter_call(scene: CrashScene) -> Cause | None:
    """Return the cause of an exception about a parameter, its range or its callback, or None for other exceptions."""
    text, error = scene.crash.message, scene.crash.error
    if f"has no attribute '{OLD}'" in text:
        told = f"{OLD} belongs to older distributions of ROS 2. In Jazzy, the method is {NEW}."
        return Cause("attribute-missing", told).fixed_by(at(scene.crash.where, f".{OLD}", f".{NEW}"))
    if "'SetParametersResult' object is not iterable" in text and scene.evidence.code.calls(BEFORE):
        told = f"The callback of {BEFORE} returns a list of parameters. One that refuses values belongs to {NEW}."
        place = scene.evidence.place(BEFORE)
        return Cause("result-not-returned", told, place).fixed_by(at(place, BEFORE, NEW))
    if (OF_RANGE.search(text) and scene.calls_on_line("IntegerRange")) or "The 'integer_range' field must be" in text:
        told = "integer_range and IntegerRange are for whole numbers. For a float, use floating_point_range and "
        return Cause("parameter-descriptor", f"{told}FloatingPointRange.")
    if "element <rclpy.parameter.Parameter object" in text and scene.calls_on_line("declare_parameter"):
        return Cause("parameter-type", 'declare_parameter takes the name and the default value, as in ("volume", 1.0).')
    if error == "ParameterNotDeclaredException":
        return _replaced(scene) or _called_too_soon(scene)
    if error == "InvalidParameterValueException" and (types := TYPES.search(text)) is not None:
        told = f"The parameter has the type {types['wanted']}, and the value has the type {types['given']}."
        if scene.calls_on_line("set_descriptor"):
            told = "The descriptor for set_descriptor needs its field type. Pass it to declare_parameter instead."
        return Cause("parameter-type", told)
    return _without_value(scene)


def _replaced(scene: CrashScene) -> Cause | None:
    """Return the cause if the class assigns the attribute in which rclpy keeps the parameters, else None."""
    own = scene.own_class
    lines = [line for name, line in attributes_set(own) if name == STORE] if own is not None else []
    if not lines:
        return None
    text = f"rclpy keeps the parameters of a node in self.{STORE}, which this line replaces. Choose another name."
    return Cause("name-of-node", text, scene.at(lines[0]))


def _called_too_soon(scene: CrashScene) -> Cause | None:
    """Return the cause if declare_parameter calls a callback that reads a parameter declared later, else None."""
    around = scene.function.name if scene.function is not None else ""
    for call in scene.evidence.code.calls(NEW):
        names = [name for module, name in callbacks_of(scene.evidence, NEW) if module is call.module]
        later = [each for each in scene.evidence.code.calls("declare_parameter") if each.module is call.module]
        later = [each for each in later if each.node.lineno > call.node.lineno]
        if around in names and later:
            text = (
                f"declare_parameter on line {later[0].node.lineno} already calls {shorten(around)}, which is "
                "registered here. Declare all parameters before you register it."
            )
            return Cause("parameter-undeclared", text, call.where)
    return None


def _without_value(scene: CrashScene) -> Cause | None:
    """Return the cause if a parameter that the function reads was declared without a default value, else None."""
    found = WITHOUT_VALUE.search(scene.crash.message)
    computes = scene.crash.error == "TypeError" and "NoneType" in scene.crash.message
    none = computes and not scene.calls_on_line("get_parameter")
    if found is None and not none:
        return None
    function = scene.function
    reads = [node for node in ast.walk(function) if isinstance(node, ast.Call)] if function is not None else []
    read = {_first(node) for node in reads if getattr(node.func, "attr", "") == "get_parameter"}
    read = read if found is None else {found["name"]}
    for call in scene.evidence.code.calls("declare_parameter"):
        name, value = _first(call.node), call.argument(1, "value")
        if name in read - {""} and (value is None or "Parameter.Type." in (dotted(value) or "")):
            text = f"{shorten(name)} has no value, since it is declared without one. Write its default after the name."
            return Cause("none-before-message", text, call.where)
    return None


def _first(call: ast.Call) -> str:
    """Return the first argument of the call if it is a string, else an empty string."""
    value = getattr(call.args[0], "value", None) if call.args else None
    return value if isinstance(value, str) else ""

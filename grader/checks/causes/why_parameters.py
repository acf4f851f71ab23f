"""Explain why one of the student's functions was called with too few or too many arguments."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import methods
from grader.checks.causes.why_other_object import CREATE_OBJECT
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene, Function

PASSED = {
    "create_timer": "A timer calls its callback without arguments.",
    "create_subscription": "A subscription passes the message to its callback.",
    "create_service": "A service passes the request and the response to its callback.",
    "add_done_callback": "A future passes itself to its callback.",
    "add_on_set_parameters_callback": "The callback for parameters gets the list of new parameters.",
}
"""Maps a method that takes a callback to a sentence about the arguments of the callback."""
IN_GENERAL = "A timer passes no argument, a subscription passes the message, and a future passes itself."


def too_few(scene: CrashScene, function: str, names: str) -> Cause | None:
    """Return the cause if one of the student's functions was called without the arguments `names`, else None."""
    own = scene.functions(function)
    if not own:
        return None
    if function == "__init__" and (created := _created(scene, names)) is not None:
        return created
    inside = any(own[0] in methods(each) for each in scene.classes)
    if not inside:
        text = (
            f"{function} is called without a value for {shorten(names)}. A parameter with a default value needs no "
            "argument."
        )
        return Cause("argument-missing", text, scene.at(own[0]))
    called = next(iter(scene.calls_on_line(function)), None)
    if called is not None:
        if any(called in node.args for node in scene.on_line if isinstance(node, ast.Call)):
            text = f"With () after its name, {function} is called immediately. To pass the method itself, omit the ()."
            return Cause("callback-called", text, scene.at(called))
        owner = (dotted(called.func) or "").rpartition(".")[0]
        if names.strip("'") == "self" and scene.class_named(owner) is not None:
            text = f"This line calls {function} on the class {owner}, not on an object. {CREATE_OBJECT}"
            return Cause("class-for-object", text, scene.at(called))
        used = {node.id for node in ast.walk(own[0]) if isinstance(node, ast.Name)}
        if not used & set(re.findall(r"'(\w+)'", names)):
            what, them = ("parameters", "them") if " and " in names else ("parameter", "it")
            text = (
                f"{function} does not use its {what} {shorten(names)}, and the call on line {called.lineno} passes "
                f"no value for {them}."
            )
            return Cause("argument-missing", text, scene.at(own[0]))
        text = f"{function} is called here without a value for {shorten(names)}."
        return Cause("argument-missing", text, scene.at(called))
    of_class = _method_of_class(scene, function) if names.strip("'") == "self" else None
    if of_class is not None:
        return of_class
    text = f"Nothing is passed for {shorten(names)}. {_passed(scene, function)}"
    return Cause("callback-parameters", text, scene.at(own[0]))


def _created(scene: CrashScene, names: str) -> Cause | None:
    """Return the cause if the line creates an object of a class in this file without these arguments, else None."""
    for own in scene.classes:
        if any(method.name == "__init__" for method in methods(own)) and scene.calls_on_line(own.name):
            text = f"An object of {own.name} is created here without a value for {shorten(names)}."
            return Cause("argument-missing", text)
    return None


def _method_of_class(scene: CrashScene, function: str) -> Cause | None:
    """Return the cause if a method of a class is passed as a callback without an object, else None."""
    for own in scene.classes:
        name = f"{own.name}.{function}"
        for node in scene.nodes:
            if isinstance(node, ast.Call) and name in [dotted(argument) for argument in node.args]:
                text = f"{name} does not belong to an object. Pass the method of an object, as in self.{function}."
                return Cause("class-for-object", text, scene.at(node))
    return None


def too_many(scene: CrashScene, function: str) -> Cause | None:
    """Return the cause if one of the student's functions was called with more arguments than it takes, else None."""
    own = scene.functions(function)
    if not own:
        return None
    first = [each.arg for each in (*own[0].args.posonlyargs, *own[0].args.args)][:1]
    inside = any(own[0] in methods(each) for each in scene.classes)
    place = scene.at(own[0])
    if inside and first != ["self"] and not _is_static(own[0]):
        fix = at(place, f"{function}(", f"{function}(self{', ' if first else ''}")
        text = f"{function} is a method, so its first parameter must be self."
        return Cause("self-parameter", text, place).fixed_by(fix)
    by_others = function != "__init__" and not scene.calls_on_line(function)
    passed = _passed(scene, function) if by_others else ""
    text = f"{function} is called with an argument but has no parameter for it. {passed}".rstrip()
    return Cause("callback-parameters", text, place).fixed_by(at(place, "(self)", "(self, _)"))


def _is_static(method: Function) -> bool:
    """Return whether the method is a static method or a class method, so that its first parameter is not self."""
    return any(dotted(each) in ("staticmethod", "classmethod") for each in method.decorator_list)


def _passed(scene: CrashScene, function: str) -> str:
    makers = [maker for maker in PASSED if any(name == function for _, name in callbacks_of(scene.evidence, maker))]
    return PASSED[makers[0]] if len(makers) == 1 else IN_GENERAL

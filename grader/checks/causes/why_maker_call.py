"""Explain a TypeError because of a wrong argument of create_timer, or of a similar method of a node."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

PLACES = {"create_timer": 1, "create_service": 2}
"""Maps a method of the node to the position (from 0) of the callback among its arguments."""
NO_ARGUMENT = re.compile(r"<lambda>\(\) missing \d+ required positional arguments?: (?P<names>.*)")
AN_ARGUMENT = re.compile(r"<lambda>\(\) takes 0 positional arguments but \d+ (?:was|were) given")
NOT_CALLABLE = "'str' object is not callable"
NO_PERIOD = "float() argument must be a string or a real number"
MISSING = re.compile(r"\bNode\.(?P<function>\w+)\(\) missing ")


def why_maker_call(scene: CrashScene) -> Cause | None:
    """Return the cause if create_timer or a similar method got a wrong period, callback or object, else None."""
    text = scene.crash.message
    if NO_PERIOD in text and scene.calls_on_line("create_timer"):
        return Cause("crash", "The first argument of create_timer is the period, a number of seconds.")
    if "incompatible constructor arguments" in text and (swapped := _name_last(scene)) is not None:
        return swapped
    if NOT_CALLABLE in text:
        return _callback_in_quotes(scene)
    if (few := NO_ARGUMENT.search(text)) is not None:
        passed = f"A lambda is called without a value for {shorten(few['names'])}."
        general = "A timer passes no argument to its callback; a subscription passes the message."
        return Cause("callback-parameters", f"{passed} {general}")
    if AN_ARGUMENT.search(text):
        return Cause("callback-parameters", "A lambda is called with an argument, but it has no parameter.")
    if "parameter must be instance of type" in text and scene.calls_on_line("set_parameters"):
        return Cause("crash", "set_parameters takes a list of objects of the class Parameter.")
    if "Invalid parameter tuple" in text:
        return Cause("crash", "declare_parameters takes a list of tuples, each with a name and a default value.")
    missing = MISSING.search(text)
    name = missing["function"] if missing is not None else ""
    if name in ros_names.NODE and any(dotted(call.func) == f"Node.{name}" for call in scene.calls_on_line(name)):
        text = f"This line calls {name} on the class Node. Inside a method of the node, write self.{name}."
        return Cause("class-for-object", text)
    return None


def _name_last(scene: CrashScene) -> Cause | None:
    """Return the cause if create_service got the callback before the name of the service, else None."""
    for call in scene.calls_on_line("create_service"):
        if len(call.args) > 2 and isinstance(getattr(call.args[2], "value", None), str):
            text = "create_service takes the type, then the name of the service, then the callback."
            return Cause("arguments-swapped", text, scene.at(call))
    return None


def _callback_in_quotes(scene: CrashScene) -> Cause | None:
    """Return the cause if the callback of a timer or a service is a string, else None."""
    for node in scene.nodes:
        maker = getattr(node.func, "attr", "") if isinstance(node, ast.Call) else ""
        if not isinstance(node, ast.Call) or len(node.args) <= PLACES.get(maker, len(node.args)):
            continue
        given = node.args[PLACES[maker]]
        if isinstance(given, ast.Constant) and isinstance(given.value, str):
            kind = maker.removeprefix("create_")
            name = given.value.removeprefix("self.")
            wanted = f"self.{shorten(name)}" if name.isidentifier() else "self, a dot and its name,"
            write = f"Write {wanted} without quotation marks."
            text = f"The callback of a {kind} is the method itself. {write}"
            return Cause("not-callable", text, scene.at(given))
    return None

"""Explain a TypeError in a call that creates a node: super().__init__, Node.__init__, Node, or the class statement."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import methods
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.checks.causes.crash_scene import CrashScene

NO_NAME = re.compile(r"\b__init__\(\) missing .*'node_name'")
TOO_MANY = re.compile(r"\b(?P<of>\w+)\.__init__\(\) takes \d+ positional arguments? but \d+ (?:was|were) given")
KEYWORD = re.compile(r"\bNode\.__init__\(\) got an unexpected keyword argument '(?P<name>\w+)'")
NOT_A_STRING = "__init__(): incompatible constructor arguments"
NO_BASE = "object.__init__() takes exactly one argument"
OF_A_MODULE = re.compile(r"^module(?:\.__init__)?\(\) takes at most 2 arguments")
OF_SUPER = "super().__init__"


def why_init_call(scene: CrashScene) -> Cause | None:
    """Return the cause if the call that creates the node has wrong arguments or a wrong base class, else None."""
    text, call = scene.crash.message, _call(scene)
    giver = _written(call) if call is not None else ""
    if "descriptor '__init__'" in text and "'super'" in text:
        return Cause("not-called", "super is a function. Write super().__init__, with parentheses after super.")
    if NO_NAME.search(text):
        return _init_misspelt(scene) or _no_name(call, giver)
    many, keyword = TOO_MANY.search(text), KEYWORD.search(text)
    if many is not None and giver == OF_SUPER and scene.class_named(many["of"]) is None and call is not None:
        if call.args and dotted(call.args[0]) == "self":
            return Cause("too-many-arguments", "super() already passes self. Leave out self in the parentheses.")
        if many["of"] == "Node":
            only = "Pass only the node name to super().__init__, or write names such as namespace= before the others."
            return Cause("too-many-arguments", only)
    if keyword is not None:
        more = " Pass the node name as the first argument, without a name and =." if "name" in keyword["name"] else ""
        return Cause("unexpected-keyword", f"Node has no parameter {keyword['name']}.{more}")
    if NOT_A_STRING in text and call is not None:
        return Cause("crash", "The node name must be a string in quotation marks, or a variable with a string.")
    return _base_class(scene, text)


def _call(scene: CrashScene) -> ast.Call | None:
    """Return the call to __init__, Node or create_node on the line, or None."""
    names = ("__init__", "Node", "create_node")
    return next((call for name in names for call in scene.calls_on_line(name)), None)


def _written(call: ast.Call) -> str:
    """Return the function of the call as the student wrote it, such as Node.__init__."""
    name = dotted(call.func) or OF_SUPER
    return OF_SUPER if name.startswith("super") else name


def _no_name(call: ast.Call | None, giver: str) -> Cause:
    if call is not None and giver.endswith(".__init__") and giver != OF_SUPER:
        text = f"Pass self and then the node name, a string, to {shorten(giver)}."
        return Cause("node-name-missing", text)
    to = giver or OF_SUPER
    return Cause("node-name-missing", f"Pass the node name, a string, to {shorten(to)}.")


def _base_class(scene: CrashScene, text: str) -> Cause | None:
    """Return the cause if the class on the line has no base class, or a module as its base class, else None."""
    own = scene.own_class
    if own is None:
        return None
    if NO_BASE in text and not own.bases:
        text = f"{own.name} has no base class. A node needs the base class Node: class {own.name}(Node)."
        return Cause("attribute-missing", text, scene.at(own))
    if OF_A_MODULE.search(text) and own.bases and scene.line == own.lineno:
        base = shorten(ast.unparse(own.bases[0]))
        text = f"{base} is a module, not a class. The class of a node is Node, in the module rclpy.node."
        return Cause("import-wrong-place", text)
    return None


def _init_misspelt(scene: CrashScene) -> Cause | None:
    """Return the cause if the class of the new object has a method whose name is a misspelt __init__, else None."""
    created = (each for each in scene.classes if scene.calls_on_line(each.name))
    return next(filter(None, (misspelt_init(scene, own) for own in created)), None)


def misspelt_init(scene: CrashScene, own: ast.ClassDef, lines: Collection[int] = ()) -> Cause | None:
    """Return the cause if the class has a misspelt __init__ that contains one of these lines, if any, else None."""
    names = {each.name: each for each in methods(own)}
    found = [name for name in names if name.strip("_") in ("init", "int", "inti") or name == "__intit__"]
    if "__init__" in names or not found:
        return None
    method = names[found[0]]
    if lines and not any(method.lineno <= line <= (method.end_lineno or 0) for line in lines):
        return None
    text = (
        f"The class has a method {found[0]}, but only __init__ is called when an object is created. Write __init__, "
        "with two underscores on each side."
    )
    return Cause("init-misspelt", text, scene.at(method)).fixed_by(at(scene.at(method), found[0], "__init__"))

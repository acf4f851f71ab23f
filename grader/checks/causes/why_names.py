"""Why a name or an attribute was not there: NameError, UnboundLocalError and AttributeError of a student's node."""

from __future__ import annotations

import ast
import builtins
import math
import random
import re
import time
from typing import TYPE_CHECKING

from grader.checks.causes import ros_names
from grader.checks.causes.cause import Cause
from grader.checks.causes.crash_scene import Function, attributes_set, methods
from grader.common.words import a_list, nearest, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.checks.causes.crash_scene import Scene

UNBOUND = re.compile(r"local variable '(?P<name>\w+)'")
NO_NAME = re.compile(r"name '(?P<name>\w+)' is not defined")
NO_ATTRIBUTE = re.compile(
    r"(?:'(?P<object>\w+)' object|type object '(?P<type>\w+)'|module '(?P<module>[\w.]+)')"
    r" has no attribute '(?P<name>\w+)'"
)
MODULES_READ = {"math": math, "time": time, "random": random}
WELL_KNOWN = ("rclpy", "math", "time", "random", "os", "sys")


def why_no_name(scene: Scene) -> Cause | None:
    """A name that was never defined: one of self's, one that wants an import, or one misspelt."""
    match = NO_NAME.search(scene.crash.message)
    if match is None:
        return None
    name = match["name"]
    own = scene.own_class
    if own is not None and name in {*(each.name for each in methods(own)), *(each for each, _ in attributes_set(own))}:
        return Cause("missing-self", f"{name} belongs to the object: inside of a method it is reached through self.")
    if name == "self":
        return Cause("self-parameter", "A method knows self only if self is its first parameter.")
    if name in ros_names.LIVES_IN:
        return Cause("missing-import", f"Nothing in the file imports {name}; it lives in {ros_names.LIVES_IN[name]}.")
    if name in WELL_KNOWN:
        return Cause("missing-import", f"Nothing in the file imports the module {name}.")
    guess = nearest(name, _bound(scene), alike=0.8)
    if guess is not None:
        return Cause("name-misspelt", f"There is a name {shorten(guess)}: compare the two letter by letter.")
    return Cause("name-undefined", "The name gets no value anywhere before this line. A text needs quotation marks.")


def _bound(scene: Scene) -> set[str]:
    names = {node.id for node in scene.nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    names |= {node.name for node in scene.nodes if isinstance(node, Function | ast.ClassDef)}
    names |= {node.arg for node in scene.nodes if isinstance(node, ast.arg)}
    imports = [node for node in scene.nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    names |= {alias.asname or alias.name.partition(".")[0] for node in imports for alias in node.names}
    return names | {name for name in dir(builtins) if name.islower()} | set(ros_names.LIVES_IN)


def why_unbound(scene: Scene) -> Cause:
    """A name that is assigned further down in the same function, or an attribute of that name."""
    match = UNBOUND.search(scene.crash.message)
    own = scene.own_class
    if match is not None and own is not None and match["name"] in {name for name, _ in attributes_set(own)}:
        text = f"{match['name']} belongs to the object: inside of a method it is reached through self."
        return Cause("missing-self", text)
    return Cause(
        "local-name",
        "What a function assigns to is its own, even above that line. What lives from call to call is kept in self.",
    )


def why_no_attribute(scene: Scene) -> Cause | None:
    """An attribute that is not there: by the kind of thing that it was looked for in."""
    match = NO_ATTRIBUTE.search(scene.crash.message)
    if match is None:
        return None
    name = match["name"]
    if match["module"]:
        return _of_module(match["module"], name)
    owner = match["object"] or match["type"]
    if owner in ("property", "function", "method", "builtin_function_or_method", "NoneType"):
        return _of_a_wrong_thing(scene, owner, name)
    if match["type"] or owner.startswith("Metaclass_"):
        return _not_made(owner.removeprefix("Metaclass_"))
    if scene.class_named(owner) is not None:
        return _of_own_class(scene, owner, name)
    if owner in ros_names.FIELDS:
        fields = ros_names.FIELDS[owner]
        guess = nearest(name, fields)
        more = f" Is {guess} meant?" if guess else ""
        return Cause("message-field", f"A {owner} has {a_list(fields)}.{more}")
    if owner in ros_names.OTHERS:
        return _misspelt(name, ros_names.OTHERS[owner]) or Cause(
            "attribute-missing", f"A {owner} has nothing of that name."
        )
    return None


def _of_module(module: str, name: str) -> Cause | None:
    if module == "rclpy" and name in ros_names.LIVES_IN:
        return Cause("import-wrong-place", f"{name} lives in {ros_names.LIVES_IN[name]}.")
    known: Iterable[str] = (
        ros_names.RCLPY if module == "rclpy" else dir(MODULES_READ[module]) if module in MODULES_READ else ()
    )
    return _misspelt(name, known) or Cause(
        "attribute-missing", f"The module {shorten(module)} has nothing of that name."
    )


def _misspelt(name: str, known: Iterable[str]) -> Cause | None:
    plain = {each.lower(): each for each in known}
    guess = plain.get(name.lower()) or nearest(name, known)
    if guess is None:
        return None
    return Cause("attribute-misspelt", f"There is {guess}: compare the two letter by letter, capitals too.")


def _not_made(name: str) -> Cause:
    return Cause(
        "class-for-object", f"{shorten(name)} is the class. An object of it is made by parentheses behind its name."
    )


def _of_a_wrong_thing(scene: Scene, owner: str, name: str) -> Cause | None:
    if owner == "property":
        made = next((node for node in scene.nodes if isinstance(node, ast.Assign) and _is_message(node.value)), None)
        told = _not_made(ast.unparse(made.value)) if made is not None else _not_made("It")
        return Cause(told.diagnosis, told.text, scene.at(made))
    if owner == "NoneType":
        return _of_none(scene, name)
    return Cause("not-called", "A function's name alone does not call it: the parentheses are missing.")


def _is_message(value: ast.expr) -> bool:
    return (dotted(value) or "").rpartition(".")[2] in ros_names.FIELDS


def _of_none(scene: Scene, name: str) -> Cause | None:
    """Something is None: what no message has filled yet, or what a function gave that returns nothing."""
    holders = [dotted(node.value) for node in scene.on_line if isinstance(node, ast.Attribute) and node.attr == name]
    for holder in filter(None, holders):
        values = [node for node in scene.nodes if isinstance(node, ast.Assign) and holder in map(dotted, node.targets)]
        if any(isinstance(each.value, ast.Constant) and each.value.value is None for each in values):
            text = f"{shorten(holder)} is None until the first message has arrived: ask for that before you use it."
            return Cause("none-before-message", text)
    if name == "executor":
        return Cause("no-object", "rclpy.spin was handed None instead of a node.")
    return None


def _of_own_class(scene: Scene, owner: str, name: str) -> Cause:
    own = scene.class_named(owner)
    assert own is not None
    made = next((each for each in methods(own) if each.name == "__init__"), None)
    if name.startswith("_") and made is not None:
        base = [node for node in ast.walk(made) if isinstance(node, ast.Call) and (_attr(node.func) == "__init__")]
        if not base:
            text = "Its __init__ never calls the parent's: super().__init__ is what makes a node of it."
            return Cause("super-init-missing", text, scene.at(made))
        text = "super().__init__ makes the node: nothing of a node can be used before that line."
        return Cause("super-init-late", text)
    lines = [line for attribute, line in attributes_set(own) if attribute == name]
    if lines:
        text = f"self.{shorten(name)} gets its value in line {min(lines)}, which has not been reached yet."
        return Cause("attribute-too-early", text)
    outside = next((each for each in scene.top_functions() if each.name == name), None)
    if outside is not None:
        text = f"{name} stands outside of the class: indent it as the other methods are."
        return Cause("method-outside-class", text, scene.at(outside))
    inside = next((each for method in methods(own) for each in ast.walk(method) if _is_function(each, name)), None)
    if inside is not None:
        text = f"{name} is indented too far: it stands inside of another method, where nobody else can see it."
        return Cause("method-in-method", text, scene.at(inside))
    if name == "publish":
        return Cause("node-publishes", "A node has no method publish; the publisher that it made has one.")
    known = {*ros_names.NODE, *(each.name for each in methods(own)), *(each for each, _ in attributes_set(own))}
    return _misspelt(name, known) or Cause(
        "attribute-missing", f"Nothing sets self.{shorten(name)}, and no method has that name."
    )


def _is_function(node: ast.AST, name: str) -> bool:
    return isinstance(node, Function) and node.name == name


def _attr(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else ""

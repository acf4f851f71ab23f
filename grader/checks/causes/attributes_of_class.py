"""Explain an AttributeError from the class of the object: its members, and mistakes in super().__init__."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.causes.crash_scene import attributes_set, methods
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene, Function

_WITHOUT_PUBLISH = ("create_subscription", "create_timer", "create_client", "create_service", "create_rate")
"""Methods of a node that return an object without a method publish."""


def of_super(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the line calls a misspelt __init__ of super(), else None."""
    if name.strip("_") not in ("init", "int"):
        return None
    text = "The method is named __init__, with two underscores on each side: super().__init__."
    fix = at(scene.crash.where, f"super().{name}(", "super().__init__(")
    return Cause("attribute-misspelt", text).fixed_by(fix)


def of_rclpy(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if a function or class of rclpy, such as spin, is used as a method of the node, else None."""
    if name in ("ActionClient", "create_action_client"):
        text = "A node has no method for this. Import the class ActionClient from rclpy.action, and call the class."
        return Cause("attribute-missing", text)
    if name not in ros_names.RCLPY or name in ("init", "node") or not scene.calls_on_line(name):
        return None
    return Cause("attribute-missing", f"{name} belongs to the module rclpy, not to the node. Write rclpy.{name}.")


def uncalled_init(made: Function) -> ast.expr | None:
    """Return the statement `super().__init__` without parentheses after it, or None."""
    values = [node.value for node in made.body if isinstance(node, ast.Expr)]
    return next((each for each in values if isinstance(each, ast.Attribute) and each.attr == "__init__"), None)


def needs_itself(scene: CrashScene, name: str) -> Cause:
    """Return the cause if a line assigns an attribute of self, and needs a value of the same attribute for this."""
    if f"create_{name}" in ros_names.NODE and scene.calls_on_line(name):
        text = f"A node has no method {name}. A similar name exists: create_{name}."
        fix = at(scene.crash.where, f"self.{name}(", f"self.create_{name}(")
        return Cause("attribute-misspelt", text).fixed_by(fix)
    text = f"This line needs a value of self.{shorten(name)}. Assign a first value on an earlier line."
    return Cause("attribute-too-early", text)


def members(scene: CrashScene, own: ast.ClassDef) -> set[str]:
    """Return the methods and attributes that the node's files define for a class and its base classes."""
    nodes = [node for module in scene.evidence.code.modules for node in module.nodes]
    known = {node.name: node for node in nodes if isinstance(node, ast.ClassDef)}
    family, waiting = [own], [own]
    while waiting:
        names = [(dotted(base) or "").rpartition(".")[2] for base in waiting.pop().bases]
        found = [known[name] for name in names if name in known and known[name] not in family]
        family += found
        waiting += found
    return {
        name
        for each in family
        for name in (*(method.name for method in methods(each)), *(attribute for attribute, _ in attributes_set(each)))
    }


def without_publish(scene: CrashScene, own: ast.ClassDef, name: str) -> set[str]:
    """If the line calls self.NAME.publish, return the methods and attributes that have no method publish."""
    if not any(dotted(call.func) == f"self.{name}.publish" for call in scene.calls_on_line("publish")):
        return set()
    made = [node for node in ast.walk(own) if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)]
    others = {
        target.attr
        for node in made
        if (dotted(node.value.func) or "").rpartition(".")[2] in _WITHOUT_PUBLISH  # type: ignore[attr-defined]
        for target in node.targets
        if isinstance(target, ast.Attribute)
    }
    return {*others, *ros_names.NODE, *(each.name for each in methods(own))}

"""Explain why an object is None: nothing was assigned yet, a future is not done, or a function returned nothing."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import Function
from grader.checks.causes.why_other_object import no_object
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene


def attribute_of_none(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause of an AttributeError: the object whose attribute `name` is used is None."""
    objects = [node.value for node in scene.on_line if isinstance(node, ast.Attribute) and node.attr == name]
    early = _before_message(scene, objects)
    if early is not None:
        return early
    if name == "executor":
        return no_object(scene)
    if any(isinstance(each, ast.Call) and getattr(each.func, "attr", "") == "result" for each in objects):
        text = (
            "result() of a future is None until the result has arrived. Read the result in a method that you pass to "
            "add_done_callback."
        )
        return Cause("future-for-answer", text)
    known = [holder for holder in map(dotted, objects) if holder]
    what = f"{shorten(known[0])} is None here, so it" if len(known) == 1 else "The value is None here, so it"
    text = f"{what} has no attribute {shorten(name)}. A function without a return statement returns None."
    return Cause("attribute-missing", text)


def _before_message(scene: CrashScene, objects: list[ast.expr]) -> Cause | None:
    """Return the cause if the module assigns None to one of `objects` (names or attributes), else None."""
    for holder in filter(None, map(dotted, objects)):
        values = [node for node in scene.nodes if isinstance(node, ast.Assign) and holder in map(dotted, node.targets)]
        if any(isinstance(each.value, ast.Constant) and each.value.value is None for each in values):
            text = f"{shorten(holder)} is None until it gets a value. Check for None before you use the value."
            known = _just_cleared(scene, values, holder) or _reversed(scene, holder) or _never_global(scene, holder)
            return known or Cause("none-before-message", text)
    return None


def _just_cleared(scene: CrashScene, values: list[ast.Assign], holder: str) -> Cause | None:
    """Return the cause if the line directly before the crash sets the attribute to None, else None."""
    for node in values:
        cleared = isinstance(node.value, ast.Constant) and node.value.value is None
        if cleared and node.lineno == scene.line - 1:
            text = f"Line {node.lineno} sets {shorten(holder)} to None, and the next line uses it."
            return Cause("none-before-message", text, scene.at(node))
    return None


def _reversed(scene: CrashScene, holder: str) -> Cause | None:
    """Return the cause if the function returns early when the attribute is not None, else None."""
    for node in ast.walk(scene.function) if scene.function is not None else ():
        returns = isinstance(node, ast.If) and isinstance(node.body[0], ast.Return) and node.lineno < scene.line
        if isinstance(node, ast.If) and returns and ast.unparse(node.test) == f"{holder} is not None":
            text = f"This condition is reversed: the function returns if {shorten(holder)} is not None."
            return Cause("none-before-message", text, scene.at(node))
    return None


def _never_global(scene: CrashScene, holder: str) -> Cause | None:
    """Return the cause if each function that assigns the variable of the module makes a local variable, else None."""
    body = scene.module.body if scene.module is not None else []
    at_top = any(isinstance(node, ast.Assign) and holder in map(dotted, node.targets) for node in body)
    if not at_top or any(isinstance(node, ast.Global) and holder in node.names for node in scene.nodes):
        return None
    for function in (node for node in scene.nodes if isinstance(node, Function) and node is not scene.function):
        for node in ast.walk(function):
            if isinstance(node, ast.Name) and node.id == holder and isinstance(node.ctx, ast.Store):
                text = (
                    f"{function.name} gives a value only to its own local variable {holder}. To set the variable of "
                    f"the module, {function.name} needs the line global {holder}."
                )
                return Cause("local-name", text, scene.at(node))
    return None

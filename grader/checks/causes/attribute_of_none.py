"""Explain why a value is None: it has no value yet, a future is not done, or a function returned nothing."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
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
    """Return the cause if the module sets one of these names or attributes to None, else None."""
    for holder in filter(None, map(dotted, objects)):
        values = [node for node in scene.nodes if isinstance(node, ast.Assign) and holder in map(dotted, node.targets)]
        if any(isinstance(each.value, ast.Constant) and each.value.value is None for each in values):
            text = f"{shorten(holder)} is None until it gets a value. Check for None before you use the value."
            return Cause("none-before-message", text)
    return None

"""Explain a NameError for a name that gets its value on a later line, or in another function."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import Function

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene


def bound_elsewhere(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if another function, or a later line outside all functions, assigns the name, else None."""
    for line, function in sorted(stores(scene, name), key=lambda each: each[0]):
        if function is None and line > scene.line:
            return Cause("name-too-early", f"{name} gets its value on line {line}, after this line.")
        if function is not None and function is not scene.function:
            if is_global(function, name):
                text = f"{name} gets its value on line {line}, in {function.name}. That line has not run yet."
                return Cause("name-too-early", text)
            text = (
                f"{name} is a local variable of {function.name} (line {line}). A local variable does not exist in "
                "other functions."
            )
            return Cause("local-name", text)
    return None


def stores(scene: CrashScene, name: str) -> Iterator[tuple[int, Function | None]]:
    """Yield each line that assigns or defines the name, with the innermost function that contains the line, or None."""
    for node in scene.nodes:
        stored = isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Store)
        defined = isinstance(node, Function | ast.ClassDef) and node.name == name
        if (stored or defined) and not (defined and scene.class_around(node) is not None):
            yield getattr(node, "lineno", 0), scene.function_around(node)


def is_global(function: Function, name: str) -> bool:
    """Return whether the function declares the name with a global statement."""
    return any(isinstance(node, ast.Global) and name in node.names for node in ast.walk(function))


def as_parameter(scene: CrashScene, name: str) -> str:
    """Return a sentence if the name is a parameter of another function, else an empty string."""
    for node in scene.nodes:
        if not isinstance(node, Function) or node is scene.function:
            continue
        arguments = (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)
        if name in [each.arg for each in arguments]:
            return f"{name} is a parameter of {node.name} (line {node.lineno}), and exists only in that function."
    return ""

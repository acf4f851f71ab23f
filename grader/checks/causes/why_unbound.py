"""Explain an UnboundLocalError in a student's node: the reason why a local variable had no value."""

from __future__ import annotations

import ast
import builtins
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.bindings import bindings
from grader.checks.causes.bound_elsewhere import deleted, without_items
from grader.checks.causes.crash_scene import attributes_set
from grader.checks.edit import at

if TYPE_CHECKING:
    from grader.checks.causes.bindings import Binding
    from grader.checks.causes.crash_scene import CrashScene

UNBOUND = re.compile(r"local variable '(?P<name>\w+)'")


def why_unbound(scene: CrashScene) -> Cause:
    """Return the cause of an UnboundLocalError, for example that the function assigns the name on a later line."""
    match = UNBOUND.search(scene.crash.message)
    name = match["name"] if match is not None else ""
    own = scene.own_class
    if own is not None and name in {each for each, _ in attributes_set(own)}:
        text = f"{name} belongs to the object. Inside a method, write self.{name}."
        return Cause("missing-self", text).fixed_by(at(scene.crash.where, name, f"self.{name}"))
    places = [each for each in bindings(scene, name) if each.of_class is None and not each.in_brackets]
    local = [each for each in places if each.function is not None and each.function is scene.function]
    outside = [each for each in places if each.function is None]
    known = deleted(scene, name) or (_hidden(scene, local[0], outside) if local else None)
    if known is not None:
        return known
    others = [each for each in places if each not in local and each not in outside and not each.by_global]
    if own is not None and others and _only_raised(scene, name):
        first = others[0]
        function = first.function.name if first.function is not None else ""
        text = (
            f"Line {first.line} assigns {name} without self, so {name} is a local variable of {function}. "
            f"To keep a value between calls, write self.{name} everywhere."
        )
        return Cause("missing-self", text, scene.at(first.line))
    if local and not _only_raised(scene, name) and (not_run := _not_run(scene, local[0], outside)) is not None:
        return not_run
    kept = "Store a value in self if later calls need the value."
    if own is None and not outside:
        kept = f"Give {name} a value before this line."
    elif own is None:
        kept = f"To change the variable of the module, the function needs the line global {name}."
    return Cause("local-name", f"A variable that a function assigns to is local to that function. {kept}")


def _hidden(scene: CrashScene, local: Binding, outside: list[Binding]) -> Cause | None:
    """Return the cause if the local variable has the name of a module, function or class, else None."""
    name, line = local.name, local.line
    taken = next((each for each in outside if each.is_import or each.is_definition), None)
    kind = "the built-in function" if not outside and name in dir(builtins) else None
    if taken is not None:
        kinds = {ast.Import: "the module", ast.ClassDef: "the class", ast.ImportFrom: f"what line {taken.line} imports"}
        kind = kinds.get(type(taken.node), "the function")
    if local.is_import and line > scene.line:
        text = f"Line {line} imports {name}, after this line. Import it at the top of the file."
        return Cause("name-too-early", text, scene.at(line))
    if kind is None or local.is_import:
        return None
    text = (
        f"Line {line} gives {name} another value, so in this function {name} is no longer {kind}. "
        "Choose another name for this value."
    )
    return Cause("local-name", text, scene.at(line))


def _not_run(scene: CrashScene, local: Binding, outside: list[Binding]) -> Cause | None:
    """Return the cause if the line that assigns the local variable has not run, else None."""
    name, line = local.name, local.line
    if line < scene.line:
        text = without_items(local) or f"Line {line} gives {name} a value, but that line has not run in this call."
        return Cause("local-name", text)
    if line == scene.line or outside:
        return None
    inner = next((each for each in scene.functions(name) if each.lineno == line), None)
    if scene.own_class is not None and inner is not None and inner.args.args[:1] and inner.args.args[0].arg == "self":
        text = f"{name} is indented too far: it is inside another method, so it is not a method of the class."
        return Cause("method-in-method", text, scene.at(inner))
    return Cause("name-too-early", f"{name} gets its value on line {line}, after this line.")


def _only_raised(scene: CrashScene, name: str) -> bool:
    """Return whether the function that crashed changes the variable only with assignments such as +=."""
    inside = list(ast.walk(scene.function)) if scene.function is not None else []
    raised = {id(node.target) for node in inside if isinstance(node, ast.AugAssign)}
    stored = [
        node for node in inside if isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Store)
    ]
    return bool(stored) and all(id(node) in raised for node in stored)

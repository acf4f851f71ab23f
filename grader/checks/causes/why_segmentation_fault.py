"""Explain why ROS 2 ended a student's node with a segmentation fault (SIGSEGV): an action has the wrong type."""

from __future__ import annotations

import ast
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.bindings import bindings
from grader.checks.causes.crash_scene import CrashScene
from grader.common.words import shorten
from grader.submission.code import module_file
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.submission.code import Call

MAKERS = ("ActionClient", "ActionServer")
"""The classes of rclpy that use their second argument as the type of an action without checking it."""
KINDS = {"msg": "a message", "srv": "a service"}
"""Maps the last part of the name of a module to a phrase for the interfaces in it."""
PARTS = ("Goal", "Result", "Feedback")
BRANCHES = (ast.If, ast.IfExp, ast.For, ast.While, ast.Lambda, ast.Match)
LOW_LEVEL = frozenset({"ctypes", "cffi"})
"""Modules with which a program itself can cause a segmentation fault."""


def why_segmentation_fault(scene: CrashScene) -> Cause | None:
    """Return the cause if the node creates a client or server of an action with another type at its start, else None.

    A segmentation fault has no traceback, so the source alone shows the cause.
    """
    code = scene.evidence.code
    imports = [alias for module in code.modules for node in module.nodes for alias in _modules(node)]
    if LOW_LEVEL & {name.partition(".")[0] for name in imports}:
        return None
    for maker in MAKERS:
        for call in code.calls(maker):
            here = CrashScene(scene.evidence, replace(scene.crash, where=call.where))
            text = _wrong_type(here, call, maker)
            if text is not None and _runs_at_start(here, call.node):
                return Cause("wrong-type", f"{text} rclpy does not check this, and crashes.", call.where)
    return None


def _modules(node: ast.AST) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module or ""] if isinstance(node, ast.ImportFrom) else []


def _wrong_type(scene: CrashScene, call: Call, maker: str) -> str | None:
    """Return a sentence about the type if it is a message, a service, or only a part of an action, else None."""
    given = call.argument(1, "action_type")
    given = given.func if isinstance(given, ast.Call) else given
    name, _, part = (dotted(given) or "" if given is not None else "").partition(".")
    module = _imported_from(scene, maker)
    if not name or module != "rclpy.action":
        return None
    package, _, kind = (_imported_from(scene, name) or "").rpartition(".")
    if not package or module_file(f"{package}.{kind}", scene.evidence.submission.files) is not None:
        return None
    if kind in KINDS:
        return f"{shorten(name)} is the type of {KINDS[kind]}. {maker} needs the type of an action."
    if kind == "action" and part in PARTS:
        return f"{maker} needs the whole type of the action, {shorten(name)}, and not {shorten(name)}.{part}."
    return None


def _imported_from(scene: CrashScene, name: str) -> str | None:
    """Return the module from which the file imports this name, or None if the name can have another value."""
    bound = bindings(scene, name)
    parameters = {node.arg for node in scene.nodes if isinstance(node, ast.arg)}
    node = bound[0].node if len(bound) == 1 else None
    if not isinstance(node, ast.ImportFrom) or node.level or name in parameters:
        return None
    # With `import ... as`, the name in the file is not the name of the type.
    return node.module if any(alias.name == name and alias.asname is None for alias in node.names) else None


def _runs_at_start(scene: CrashScene, call: ast.Call) -> bool:
    """Return whether the call is in main, at the top level, or in __init__ of a class that is used; not in a branch."""
    if any(each is call for node in scene.nodes if isinstance(node, BRANCHES) for each in ast.walk(node)):
        return False
    function = scene.function_around(call)
    if function is None or function.name == "main":
        return True
    around = scene.class_around(function)
    return function.name == "__init__" and around is not None and bool(scene.evidence.code.calls(around.name))

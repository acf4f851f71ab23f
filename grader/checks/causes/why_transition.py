"""Explain why a transition of a lifecycle node failed. rclpy hides exceptions in callbacks such as on_configure."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.causes.crash_scene import Function

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

CALLBACKS = ("on_configure", "on_activate", "on_deactivate", "on_cleanup")


def why_no_transition(scene: CrashScene) -> Cause | None:
    """Return the cause of a failed transition, such as a class that a callback uses without importing it, or None."""
    if "lifecycle state machine transition" not in scene.crash.message:
        return None
    known = {alias.asname or alias.name for node in scene.nodes for alias in _imported(node)}
    known |= {node.name for node in scene.nodes if isinstance(node, Function | ast.ClassDef)}
    for name in CALLBACKS:
        for node in (each for method in scene.functions(name) for each in ast.walk(method)):
            if isinstance(node, ast.Name) and node.id in ros_names.MODULE_OF and node.id not in known:
                text = f"rclpy hides the exception in {name}: the file does not import {node.id}."
                return Cause("missing-import", text, scene.at(node))
    text = "An earlier transition may have failed. rclpy hides an exception in a callback such as on_configure."
    return Cause("crash", text)


def _imported(node: ast.AST) -> list[ast.alias]:
    return node.names if isinstance(node, ast.Import | ast.ImportFrom) else []

"""Explain from the source code why a program exited on its own or ran without a node."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import SPINS
from grader.checks.causes.why_other_object import CREATE_OBJECT
from grader.evidence.activity import ended_at_start
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence

EXITS = ("exit", "quit", "sys.exit", "os._exit", "SystemExit", "rclpy.shutdown", "rclpy.try_shutdown")


def why_ended(evidence: Evidence) -> Cause:
    """Return the reason why the program exited on its own, without an exception."""
    code = evidence.code
    bare = named_only(evidence, "rclpy.init", "rclpy.spin", "main")
    if bare is not None:
        return bare
    threaded = spins_in_a_thread(evidence)
    if threaded is not None:
        return threaded
    if not any(code.calls(name) for name in SPINS):
        return Cause("no-spin", "rclpy.spin keeps a node running, but it is never called.", evidence.place("init"))
    if not code.calls("spin") and code.calls("spin_once") and not loops(evidence):
        text = "rclpy.spin_once handles one event and returns. rclpy.spin continues until Ctrl-C."
        return Cause("spin-once", text, evidence.place("spin_once"))
    for call in code.calls("spin_until_future_complete"):
        if call.argument(3, "timeout_sec") is not None and not code.calls("spin"):
            text = (
                "With timeout_sec, spin_until_future_complete returns after this time at the latest. rclpy.spin runs "
                "until Ctrl-C."
            )
            return Cause("ended-early", text, call.where)
    returned = _returns_before_spin(evidence) or _spins_only_as_script(evidence)
    if returned is not None:
        return returned
    stop = _exits(evidence)
    ended: Diagnosis = "ends-at-once" if ended_at_start(evidence.recording) else "ended-early"
    if stop is not None:
        return Cause(ended, "This line may end the program.", stop)
    return Cause(ended, "", evidence.place("spin", "init"))


def spins_in_a_thread(evidence: Evidence) -> Cause | None:
    """Return the cause if only another thread spins the node, and main does not wait for that thread, else None."""
    code = evidence.code
    if code.calls("join") or any(code.calls(name) for name in SPINS) or loops(evidence):
        return None
    for call in code.calls("Thread"):
        target = call.argument(1, "target")
        if target is not None and (dotted(target) or "").rpartition(".")[2] in SPINS:
            text = (
                f"{dotted(target)} runs in this thread. The main thread does not wait for it, so the program goes on "
                "to the lines that end it. Call rclpy.spin in main, without a thread."
            )
            return Cause("ends-at-once", text, call.where)
    return None


def _returns_before_spin(evidence: Evidence) -> Cause | None:
    """Return the cause if a function returns unconditionally before it calls a function named spin, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if not isinstance(node, ast.FunctionDef):
                continue
            lines = [each.lineno for each in node.body if isinstance(each, ast.Return)]
            spins = [each.lineno for each in ast.walk(node) if isinstance(each, ast.Call) and _is_spin(each)]
            if lines and spins and min(lines) < min(spins):
                text = f"{node.name} returns here, before it spins the node."
                return Cause("ends-at-once", text, Where(module.file, min(lines)))
    return None


def _spins_only_as_script(evidence: Evidence) -> Cause | None:
    """Return the cause if all calls to spin are in the block of `if __name__ == "__main__"`, else None."""
    spins = evidence.code.calls("spin") if evidence.entry_point() is not None else []
    for module in evidence.code.modules:
        for node in module.body:
            below = list(ast.walk(node)) if isinstance(node, ast.If) and "__name__" in ast.unparse(node.test) else []
            if spins and all(call.node in below for call in spins):
                text = (
                    "The node is spun only in this block, which does not run: ros2 run calls the function of the entry "
                    "point."
                )
                return Cause("ends-at-once", text, Where(module.file, node.lineno))
    return None


def _exits(evidence: Evidence) -> Where | None:
    """Return the place where a method calls exit or shutdown, or raises SystemExit, or None."""
    for module in evidence.code.modules:
        for own in (node for node in module.nodes if isinstance(node, ast.ClassDef)):
            for node in ast.walk(own):
                called = node.func if isinstance(node, ast.Call) else getattr(node, "exc", None)
                if isinstance(called, ast.expr) and dotted(called) in EXITS:
                    return Where(module.file, called.lineno)
    return None


def _is_spin(call: ast.Call) -> bool:
    return (dotted(call.func) or "").rpartition(".")[2] == "spin"


def why_no_node(evidence: Evidence) -> Cause:
    """Return the reason why the program runs without creating a node."""
    code = evidence.code
    bare = named_only(evidence, "rclpy.init", "main")
    if bare is not None:
        return bare
    if not code.calls("init"):
        return Cause("no-init", "rclpy.init is never called.", code.start)
    entry = (evidence.entry_point() or "").rpartition(":")[2]
    mentioned = {entry, *(_named(node) for module in code.modules for node in module.nodes)}
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, ast.ClassDef) and node.name not in mentioned and _is_node(node):
                text = f"The class {node.name} is defined but never called. Call the class to create the node."
                return Cause("node-not-made", text, Where(module.file, node.lineno))
    text = "The program may wait or loop forever before it creates the node, or it may never create a node."
    return _stored_class(evidence) or Cause("no-node", text, evidence.place("init"))


def _stored_class(evidence: Evidence) -> Cause | None:
    """Return the cause if a node class, not an instance, is assigned to a variable that nothing reads, else None."""
    nodes = [(module, node) for module in evidence.code.modules for node in module.nodes]
    classes = {node.name for _, node in nodes if isinstance(node, ast.ClassDef) and _is_node(node)}
    read = {node.id for _, node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    for module, node in nodes:
        if not isinstance(node, ast.Assign) or any(_named(target) in read for target in node.targets):
            continue
        if _named(node.value) in classes:
            text = f"This line stores the class {_named(node.value)}, not an object. {CREATE_OBJECT}"
            return Cause("node-not-made", text, Where(module.file, node.lineno))
    return None


def _named(node: ast.AST) -> str:
    """Return the name, or the last part of a dotted name, or an empty string for other expressions."""
    return getattr(node, "id", "") if isinstance(node, ast.Name) else getattr(node, "attr", "")


def named_only(evidence: Evidence, *names: str) -> Cause | None:
    """Return the cause if a line mentions one of these functions without calling it, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Expr) and dotted(node.value) in names:
                text = f"This line mentions {dotted(node.value)} but does not call it: the parentheses are missing."
                return Cause("not-called", text, Where(module.file, node.lineno))
    return None


def _is_node(of: ast.ClassDef) -> bool:
    return any((dotted(base) or "").rpartition(".")[2] == "Node" for base in of.bases)


def loops(evidence: Evidence) -> bool:
    """Return whether the code of the node has a loop."""
    return any(isinstance(node, ast.While | ast.For) for module in evidence.code.modules for node in module.nodes)

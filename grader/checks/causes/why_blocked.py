"""Explain why a node stops doing anything: a callback waits, or the program waits before it spins the node."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.awaiting import awaits_in_group, never_awaited
from grader.checks.causes.callback_code import functions_in_callbacks, inside
from grader.checks.causes.unset_state import unset_state
from grader.checks.causes.waiting import clients_of, has_threads, waits_in_callback
from grader.checks.causes.why_other_object import NEED_THE_NODE
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

ANSWERS = ("wait_for_service", "service_is_ready", "wait_for_server", "server_is_ready")
"""Methods of clients that return True as soon as the server exists."""
HARMLESS = frozenset({"sleep", "sleep_for", "print", "debug", "info", "warning", "warn", "error"})
"""Functions in a loop that only waits: they sleep, or report that the node waits."""
EXECUTORS = ("SingleThreadedExecutor", "MultiThreadedExecutor")
NODE_MAKERS = ("create_node", "Node")
"""Functions that create a node. The student's own classes of nodes do, too."""
WAKES = ("create_timer", "create_subscription", "create_service", "create_client", "ActionServer", "ActionClient")
"""Functions that give a node something to do when it is spun."""


def why_blocked(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback never ends, or a call before rclpy.spin waits for a response, else None."""
    coroutine = awaits_in_group(evidence) or never_awaited(evidence)
    blocked = waits_in_callback(evidence) or coroutine or idle_loop(evidence) or _call_before_spin(evidence)
    return blocked or unset_state(evidence)


def idle_loop(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback loops until another callback changes a value, else None."""
    if has_threads(evidence):
        return None
    for module, function in functions_in_callbacks(evidence.code.modules):
        for node in inside(function):
            if isinstance(node, ast.While) and only_waits(node) and _tests_value(node.test):
                text = (
                    "This loop is in a callback. While it waits, a node with one thread calls no other callback, so "
                    "the value never changes. Return instead, and look again in the next call."
                )
                return Cause("loops-in-callback", text, Where(module.file, node.lineno))
    return None


def _tests_value(test: ast.expr) -> bool:
    """Return whether a condition depends on an attribute, and not on the time or on a call."""
    calls = any(isinstance(node, ast.Call) for node in ast.walk(test))
    return not calls and any(isinstance(node, ast.Attribute) for node in ast.walk(test))


def only_waits(loop: ast.While) -> bool:
    """Return whether a loop does nothing but wait, and waits for something other than a server.

    The condition for which it waits can also be in an if statement with a break.
    """
    breaks = [each for each in loop.body if isinstance(each, ast.If) and isinstance(each.body[0], ast.Break)]
    tests = [loop.test, *(each.test for each in breaks)]
    if any(isinstance(each, ast.Attribute) and each.attr in ANSWERS for test in tests for each in ast.walk(test)):
        return False
    others = [each for each in loop.body if each not in breaks]
    calls = [each.value for each in others if isinstance(each, ast.Expr)]
    return all(isinstance(each, ast.Pass | ast.Expr) for each in others) and all(
        isinstance(call, ast.Call) and getattr(call.func, "attr", getattr(call.func, "id", "")) in HARMLESS
        for call in calls
    )


def _call_before_spin(evidence: Evidence) -> Cause | None:
    """Return the cause if __init__ waits for the response of a service, else None."""
    if has_threads(evidence):
        return None
    clients = clients_of(evidence.code.modules)
    for call in evidence.code.calls("call"):
        owner = dotted(call.node.func.value) if isinstance(call.node.func, ast.Attribute) else None
        inits = [node for node in call.module.nodes if isinstance(node, ast.FunctionDef) and node.name == "__init__"]
        if owner in clients and any(call.node in list(inside(each)) for each in inits):
            limit = call.argument(1, "timeout_sec")
            timed = limit is not None and not (isinstance(limit, ast.Constant) and limit.value is None)
            end = "no response arrives" if timed else "call never returns"
            text = (
                "call waits for the response, which arrives only while the node is spun. __init__ runs before "
                f"rclpy.spin, so {end}. Use call_async."
            )
            return Cause("blocks-in-init", text, call.where)
    return None


def not_spun(evidence: Evidence) -> Cause | None:
    """Return the cause if an executor spins without a node, or if nothing spins one of several nodes, else None."""
    return _empty_executor(evidence) or _second_node(evidence)


def _empty_executor(evidence: Evidence) -> Cause | None:
    """Return the cause if an executor spins without a node, else None."""
    code = evidence.code
    made = {target for name in EXECUTORS for target in _targets(evidence, name)}
    filled = any(getattr(node, "attr", "") == "add_node" for module in code.modules for node in module.nodes)
    for call in code.calls("spin"):
        owner = dotted(call.node.func.value) if isinstance(call.node.func, ast.Attribute) else None
        if owner in made and not call.node.args and not filled and not _used(evidence, owner):
            text = f"{owner} has no node, so it calls no callback. add_node adds a node to an executor."
            return Cause("no-spin", text, call.where)
    return None


def _second_node(evidence: Evidence) -> Cause | None:
    """Return the cause if the program spins a node, but does not spin another node that has callbacks, else None."""
    classes = {
        node.name: node
        for module in evidence.code.modules
        for node in module.nodes
        if isinstance(node, ast.ClassDef) and any((dotted(base) or "").endswith("Node") for base in node.bases)
    }
    made = {
        target: (place, classes.get(name))
        for name in (*NODE_MAKERS, *classes)
        for target, place in _targets(evidence, name).items()
    }
    given = [call.argument(0, "node") for name in NEED_THE_NODE for call in evidence.code.calls(name)]
    spun = {dotted(each) for each in given if each is not None}
    if not spun or not spun <= {*made}:
        return None  # self, another name for a node, or a list of nodes
    for target, (place, own) in made.items():
        if target not in spun and not _used(evidence, target) and _has_callbacks(evidence, target, own):
            text = f"Nothing spins the node {target}, so none of its callbacks is called. rclpy.spin spins one node."
            return Cause("no-spin", text, place)
    return None


def _used(evidence: Evidence, name: str) -> bool:
    """Return whether the code passes on the object in this variable, or sets the executor of a node."""
    for module in evidence.code.modules:
        owners = {id(node.value) for node in module.nodes if isinstance(node, ast.Attribute)}
        for node in module.nodes:
            if not isinstance(node, ast.Name | ast.Attribute):
                continue
            loaded = isinstance(node.ctx, ast.Load) and id(node) not in owners and dotted(node) == name
            if loaded or (isinstance(node.ctx, ast.Store) and getattr(node, "attr", "") == "executor"):
                return True
    return False


def _has_callbacks(evidence: Evidence, target: str, own: ast.ClassDef | None) -> bool:
    """Return whether something that needs a spin is created on the node in this variable, or in its class."""
    inside = [node for node in ast.walk(own) if isinstance(node, ast.Call)] if own is not None else []
    if any((dotted(node.func) or "").rpartition(".")[2] in WAKES for node in inside):
        return True
    calls = [call.node for name in WAKES for call in evidence.code.calls(name)]
    return any((dotted(node.func) or "").rpartition(".")[0] == target for node in calls)


def _targets(evidence: Evidence, maker: str) -> dict[str, Where]:
    """Return the variables to which the result of a call to this function is assigned, with their places."""
    found: dict[str, Where] = {}
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
                name = (dotted(node.value.func) or "").rpartition(".")[2]
                targets = [dotted(each) or "" for each in node.targets] if name == maker else []
                found |= {target: Where(module.file, node.lineno) for target in targets if target}
    return found

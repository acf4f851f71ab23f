"""Explain why a running node sends nothing: something blocks its timers, methods or messages."""

from __future__ import annotations

import ast
import math
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import inside
from grader.checks.causes.timers import timer_fault
from grader.checks.causes.waiting import SPINS, timeout_s
from grader.checks.causes.why_blocked import WAKES, not_spun, only_waits, why_blocked
from grader.checks.causes.why_ended import named_only
from grader.checks.causes.why_inactive import never_activated
from grader.checks.causes.why_never_set import never_set
from grader.common.words import nearest, shorten
from grader.submission.constants import dotted, evaluate
from grader.submission.where import Where
from grader.turtlesim.services import OF_TURTLESIM

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

INCOMPATIBLE = "incompatible QoS"
"""rclpy logs a message with these words if a publisher and a subscription cannot communicate."""
CATCH = "/catch"
ALWAYS = ("True", "1", "rclpy.ok()")


def why_qos(evidence: Evidence) -> Cause | None:
    """Return the cause if the QoS settings of a publisher and a subscription are not compatible, else None."""
    recording = evidence.recording
    output = [recording.stderr.text, *(line.text for line in recording.log)]
    if not any(INCOMPATIBLE in text for text in output):
        return None
    text = (
        "The QoS settings of a publisher and a subscription are not compatible. If you pass a queue size instead of a "
        "QoS profile, they are compatible with those of turtlesim."
    )
    return Cause("qos-mismatch", text, evidence.place("QoSProfile", "create_publisher", "create_subscription"))


def why_nothing(evidence: Evidence, sends: Sequence[str]) -> Cause | None:
    """Return the reason why the node sends nothing, or None. `sends` are the names of methods such as publish."""
    fault = timer_fault(evidence, sends)
    if fault is not None:
        return fault
    return (
        never_activated(evidence)
        or named_only(evidence, "rclpy.spin")
        or _stuck(evidence)
        or never_called(evidence, sends, only=True)
        or _no_spin(evidence, sends)
        or not_spun(evidence)
        or _nothing_to_spin(evidence)
        or never_set(evidence, sends)
        or never_called(evidence, sends)
    )


def _no_spin(evidence: Evidence, sends: Sequence[str]) -> Cause | None:
    if any(evidence.code.calls(name) for name in SPINS):
        return None
    rates = evidence.code.calls("create_rate")
    if rates and evidence.code.calls("sleep") and not evidence.code.calls("create_timer"):
        text = "The method sleep of a Rate waits forever, because nothing spins the node. Use a timer and rclpy.spin."
        return Cause("no-spin", text, rates[0].where)
    loops = [node for module in evidence.code.modules for node in module.nodes if isinstance(node, ast.While)]
    if any(calls_method(loop, name) for loop in loops for name in sends) and not any(map(evidence.code.calls, WAKES)):
        return None  # a loop sends, and the node has nothing to spin
    return Cause("no-spin", "Without rclpy.spin, no timer callback is ever called.", evidence.code.start)


def _nothing_to_spin(evidence: Evidence) -> Cause | None:
    """Return the cause if spin_once is called without a timeout in a node that has nothing to do, else None."""
    if any(evidence.code.calls(name) for name in WAKES):
        return None
    for call in evidence.code.calls("spin_once"):
        if timeout_s(call.node, "spin_once", call.module) == math.inf:
            text = "spin_once waits for something to do, but this node has no timer. Use timeout_sec to limit the wait."
            return Cause("spin-once-waits", text, call.where)
    return None


def _stuck(evidence: Evidence) -> Cause | None:
    """Return the cause if a loop or spin in __init__, or a wait for a service or response, may never end, else None."""
    for module, method in methods_of(evidence):
        for node in inside(method):
            where = Where(module.file, getattr(node, "lineno", None))
            waiting = _waits(evidence, node, module)
            if waiting is not None:
                return waiting.at(where)
            endless = isinstance(node, ast.While) and ast.unparse(node.test) in ALWAYS and not _ends(node)
            endless = endless and not spins(node)
            if method.name == "__init__" and endless:
                text = "__init__ loops forever, so rclpy.spin is never reached. A timer repeats without a loop."
                return Cause("blocks-in-init", text, where)
            spun = isinstance(node, ast.Call) and dotted(node.func) == "rclpy.spin"
            if method.name == "__init__" and spun and getattr(node, "lineno", 0) < method.body[-1].lineno:
                text = "rclpy.spin returns only after Ctrl-C, so the lines after it in __init__ do not run until then."
                return Cause("blocks-in-init", text, where)
            if method.name == "__init__" and isinstance(node, ast.While) and only_waits(node):
                text = "If this loop in __init__ does not end, rclpy.spin is never reached."
                return Cause("blocks-in-init", text, where)
    return why_blocked(evidence)


def _waits(evidence: Evidence, node: ast.AST, module: Module) -> Cause | None:
    """Return the cause if this call creates a client of a service that no node has, and the file waits for one."""
    waits = any(isinstance(each, ast.Attribute) and each.attr == "wait_for_service" for each in module.nodes)
    return not_there(evidence, node, module) if waits else None


def not_there(evidence: Evidence, node: ast.AST, module: Module) -> Cause | None:
    """Return the cause if this call creates a client of a service that no node of the trial has, else None."""
    if not isinstance(node, ast.Call) or getattr(node.func, "attr", "") != "create_client" or len(node.args) < 2:
        return None
    name = evaluate(node.args[1], module.names)
    recording = evidence.recording
    observed = {*(each.service for each in recording.offers), *(each.service for each in recording.calls)}
    observed |= {CATCH} if recording.catch_from_s is not None else set()
    known = observed | set(OF_TURTLESIM)
    if not isinstance(name, str) or f"/{name.strip('/')}" in known:
        return None
    last = name.rpartition("/")[2]
    same = next((each for each in OF_TURTLESIM if each.rpartition("/")[2] == last), None)
    guess = same or nearest(f"/{name.strip('/')}", OF_TURTLESIM)
    more = f" A similar service exists: {guess}." if guess else ""
    return Cause("service-not-there", f"The node waits for the service {shorten(name)}, which does not exist.{more}")


def returns_before(evidence: Evidence, call: str) -> Cause | None:
    """Return the cause if the only function that calls `call` returns unconditionally before the call, else None."""
    if sum(calls_method(method, call) for _, method in methods_of(evidence)) > 1:
        return None
    for module, method in methods_of(evidence):
        returns = [each.lineno for each in method.body if isinstance(each, ast.Return)]
        calls = [each.lineno for each in ast.walk(method) if isinstance(each, ast.Call) and calls_method(each, call)]
        if returns and calls and min(returns) < min(calls):
            text = f"{method.name} returns on line {min(returns)}, before it calls {call}."
            return Cause("never-publishes", text, Where(module.file, min(returns)))
    return None


def calls_method(node: ast.AST, name: str) -> bool:
    """Return whether the code calls a method with this name."""
    return any(isinstance(each, ast.Call) and getattr(each.func, "attr", "") == name for each in ast.walk(node))


def _ends(loop: ast.While) -> bool:
    """Return whether a statement in the loop may end the loop."""
    return any(isinstance(each, ast.Break | ast.Return | ast.Raise) for each in ast.walk(loop))


def spins(part: ast.AST) -> bool:
    """Return whether a part of the code spins a node, so that callbacks are called meanwhile."""
    calls = (node.func for node in ast.walk(part) if isinstance(node, ast.Call))
    return any(getattr(each, "attr", getattr(each, "id", "")) in SPINS for each in calls)


def never_called(evidence: Evidence, sends: Sequence[str], *, only: bool = False) -> Cause | None:
    """Return the cause if a method that sends something is never called and is not a callback, else None.

    With `only`, there must be no other method that sends something.
    """
    senders = [each for _, each in methods_of(evidence) if any(calls_method(each, name) for name in sends)]
    if only and len(senders) > 1:
        return None
    for module, method in methods_of(evidence):
        called = [
            node for node in ast.walk(method) if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in sends
        ]
        named = any(
            isinstance(node, ast.Attribute) and node.attr == method.name
            for each in evidence.code.modules
            for node in each.nodes
        )
        if called and not named and not _is_called_by_others(evidence, module, method):
            text = f"Nothing calls {shorten(method.name)}. The method is not the callback of a timer or a subscription."
            return Cause("method-never-called", text, Where(module.file, method.lineno))
    return None


def _is_called_by_others(evidence: Evidence, module: Module, method: ast.FunctionDef) -> bool:
    """Return whether Python (as with __call__), a base class such as Thread, or a decorator may call the method.

    A module that uses getattr may call any method.
    """
    classes = [node for each in evidence.code.modules for node in each.nodes if isinstance(node, ast.ClassDef)]
    own = next(each for each in classes if method in each.body)
    bases = {(dotted(base) or "").rpartition(".")[2] for base in own.bases} - {each.name for each in classes}
    special = method.name.startswith("__") or method.name == "destroy_node" or bool(method.decorator_list)
    return special or bool(bases - {"Node", "object"}) or any(map(_looks_up, module.nodes))


def _looks_up(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id == "getattr"


def methods_of(evidence: Evidence) -> Iterator[tuple[Module, ast.FunctionDef]]:
    """Yield the methods of all classes with their modules."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.ClassDef):
                yield from ((module, each) for each in node.body if isinstance(each, ast.FunctionDef))

"""Explain why a service call does not arrive, for example because the name of the service is wrong."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import inside
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_silent import not_there, why_nothing
from grader.common.words import nearest, shorten
from grader.submission.constants import dotted, evaluate
from grader.submission.where import Where
from grader.turtlesim.services import OF_TURTLESIM

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

WAITS = {"wait_for_service", "service_is_ready"}


def why_unasked(evidence: Evidence, service: str) -> Cause:
    """Return the most likely cause if no call arrives at this service."""
    return (
        why_blocked(evidence)
        or _wrong_name(evidence, service)
        or _never_ready(evidence)
        or why_nothing(evidence, ("call_async", "call"))
        or _too_early(evidence)
        or _never_called(evidence)
    )


def _wrong_name(evidence: Evidence, wanted: str) -> Cause | None:
    """Return the cause if a client uses a similar name, which no service of the simulator has, else None."""
    clients = evidence.code.calls("create_client")
    names = {call: evaluate(call.argument(1, "srv_name"), call.module.names) for call in clients}
    if any(isinstance(name, str) and f"/{name.strip('/')}" == wanted for name in names.values()):
        return None
    for call, name in names.items():
        if not isinstance(name, str) or f"/{name.strip('/')}" in OF_TURTLESIM:
            continue
        text = f"The client uses the name {shorten(name)}. The name of the service is {wanted}."
        near = nearest(f"/{name.strip('/')}", [wanted]) or wanted.endswith(name.rpartition("/")[2])
        if near:
            return Cause("service-name", text, call.where)
    return None


def _never_ready(evidence: Evidence) -> Cause | None:
    """Return the cause if the node calls service_is_ready of a client whose service does not exist, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Call) and _asks_whether_ready(node, module):
                cause = not_there(evidence, node, module)
                if cause is not None:
                    return cause.at(Where(module.file, node.lineno))
    return None


def _asks_whether_ready(made: ast.Call, module: Module) -> bool:
    """Return whether the module calls service_is_ready of the client that this call creates."""
    assigned = (node for node in module.nodes if isinstance(node, ast.Assign) and node.value is made)
    clients = {dotted(target) for node in assigned for target in node.targets} - {None}
    return any(
        isinstance(node, ast.Attribute) and node.attr == "service_is_ready" and dotted(node.value) in clients
        for node in module.nodes
    )


def _too_early(evidence: Evidence) -> Cause | None:
    """Return the cause if __init__, or a method that it calls, sends a request without waiting for the service."""
    nodes = [node for module in evidence.code.modules for node in module.nodes]
    functions: dict[str, list[ast.FunctionDef]] = {}
    for node in nodes:
        if isinstance(node, ast.FunctionDef):
            functions.setdefault(node.name, []).append(node)
    # A base class, or a function of the module, may wait.
    if WAITS & _called_from("__init__", functions):
        return None
    for node in nodes:
        body = node.body if isinstance(node, ast.ClassDef) else []
        own = {f"self.{each.name}": [each] for each in body if isinstance(each, ast.FunctionDef)}
        if "call_async" in _called_from("self.__init__", own):
            text = "__init__ sends a request. The request is lost if the service does not exist yet."
            return Cause("service-not-ready", text, evidence.place("call_async"))
    return None


def _called_from(name: str, functions: dict[str, list[ast.FunctionDef]]) -> set[str]:
    """Return the names of everything that this function calls, directly or through other functions in `functions`.

    A method has two names: send and self.send.
    """
    found, waiting = {name}, [name]
    while waiting:
        for function in functions.get(waiting.pop(), ()):
            called = [node.func for node in inside(function) if isinstance(node, ast.Call)]
            new = {getattr(each, "attr", "") for each in called} | {dotted(each) or "" for each in called}
            waiting += new - found
            found |= new
    return found


def _never_called(evidence: Evidence) -> Cause:
    if not evidence.code.calls("create_client"):
        return Cause(
            "service-not-called", "The node has no client for this service. See create_client.", evidence.code.start
        )
    if not evidence.code.calls("call_async") and not evidence.code.calls("call"):
        text = "Creating a client sends nothing. The client's method call_async sends a request."
        return Cause("service-not-called", text, evidence.place("create_client"))
    return Cause("service-not-called", "", evidence.place("call_async", "call"))

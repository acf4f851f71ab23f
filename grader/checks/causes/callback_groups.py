"""Find deadlocks: callbacks that wait for a response although they are in the same callback group as the client."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.waiting import Wait
    from grader.evidence.evidence import Evidence

REGISTERS = {"create_timer": 2, "create_subscription": 4, "create_service": 3}
"""Maps a method that registers a callback to the maximum number of positional arguments without a callback group."""
SELF = "self."


def in_default_group(evidence: Evidence, wait: Wait) -> bool:
    """Return whether the waiting callback and the client that it uses are both in the node's default callback group.

    The executor never calls two callbacks of this group at the same time. The result is True only if the same class
    defines the callback as a method, registers it, and creates the client.
    """
    modules = [module for module in evidence.code.modules if module.file == wait.where.file]
    if any(getattr(node, "attr", "").endswith("default_callback_group") for each in modules for node in each.nodes):
        return False
    classes = [node for module in modules for node in module.nodes if isinstance(node, ast.ClassDef)]
    return any(_waits_in_its_group(node, wait) for node in classes)


def _waits_in_its_group(node: ast.ClassDef, wait: Wait) -> bool:
    methods = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)}
    clients = _clients(node)
    waiting = {
        name
        for name, method in methods.items()
        for call in _calls(method)
        if call.lineno == wait.where.line and dotted(call.func) in {f"{client}.{wait.name}" for client in clients}
    }
    while True:
        callers = {
            name for name, method in methods.items() if any(_own(call.func) in waiting for call in _calls(method))
        }
        if callers <= waiting:
            return bool(waiting & set(_registered(node)))
        waiting |= callers


def _clients(node: ast.ClassDef) -> set[str]:
    """Return the attributes, such as self.pen, that hold a client without its own callback group."""
    return {
        dotted(target) or ""
        for each in ast.walk(node)
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Call)
        if _own(each.value.func) == "create_client" and not _grouped(each.value)
        for target in each.targets
    }


def _registered(node: ast.ClassDef) -> Iterator[str]:
    """Yield the attributes of self, such as callbacks, in calls to methods in REGISTERS that set no callback group."""
    for call in _calls(node):
        most = REGISTERS.get(_own(call.func))
        if most is not None and len(call.args) <= most and not _grouped(call):
            yield from filter(None, map(_own, [*call.args, *(keyword.value for keyword in call.keywords)]))


def _grouped(call: ast.Call) -> bool:
    return any(keyword.arg in ("callback_group", None) for keyword in call.keywords)


def _own(node: ast.expr) -> str:
    """Return the name of an attribute of self, or an empty string."""
    name = dotted(node) or ""
    return name.removeprefix(SELF) if name.startswith(SELF) and name.count(".") == 1 else ""


def _calls(node: ast.AST) -> Iterator[ast.Call]:
    return (each for each in ast.walk(node) if isinstance(each, ast.Call))

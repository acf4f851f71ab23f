"""Find deadlocks of coroutines: a callback awaits a response that the executor may not handle before it returns."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import inside, last_name
from grader.checks.causes.callback_groups import REGISTERS
from grader.checks.causes.why_rate import callbacks_of
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

ASYNCHRONOUS = ("call_async", "send_goal_async", "get_result_async", "cancel_goal_async")


def awaits_in_group(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback awaits a response of a client in its own callback group, else None.

    Without a callback group of its own, everything of a node is in one group. The executor runs one callback of this
    group at a time, and a coroutine counts as running while it awaits something. This does not apply to callbacks of
    futures, since these belong to no group.
    """
    if any(_is_of_groups(node) for node in _nodes(evidence)):
        return None
    coroutines = {node.name: node for node in _nodes(evidence) if isinstance(node, ast.AsyncFunctionDef)}
    waiting = [name for _, name in callbacks_of(evidence, *REGISTERS) if name in coroutines]
    known = {*waiting}
    while waiting:
        name = waiting.pop()
        awaits = [node for node in inside(coroutines[name]) if isinstance(node, ast.Await)]
        for each in sorted(awaits, key=lambda node: node.lineno):
            called = last_name(each.value) if isinstance(each.value, ast.Call) else ""
            if called in ASYNCHRONOUS or _is_future(coroutines[name], each.value):
                text = (
                    f"{shorten(name)} is in the same callback group as the client, and await does not end it: a "
                    "deadlock. Use add_done_callback."
                )
                return Cause("waits-in-callback", text, _where(evidence, coroutines[name], each))
            if called in coroutines and called not in known:
                known.add(called)
                waiting.append(called)
    return None


def never_awaited(evidence: Evidence) -> Cause | None:
    """Return the cause if a coroutine of the student is called like a method without await, so that it never runs.

    Return None if there is no such call.
    """
    coroutines = {node.name: node for node in _nodes(evidence) if isinstance(node, ast.AsyncFunctionDef)}
    for module in evidence.code.modules:
        for node in module.nodes:
            call = node.value if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call) else None
            called = last_name(call) if call is not None else ""
            if call is not None and called in coroutines and dotted(call.func) in {called, f"self.{called}"}:
                text = (
                    f"{shorten(called)} is a coroutine (async def), so a call without await only creates it: its code "
                    "does not run. Remove async, and use add_done_callback in place of await."
                )
                return Cause("method-never-called", text, Where(module.file, call.lineno))
    return None


def _nodes(evidence: Evidence) -> list[ast.AST]:
    return [node for module in evidence.code.modules for node in module.nodes]


def _is_of_groups(node: ast.AST) -> bool:
    """Return whether this is the argument callback_group, or the name of a class of callback groups."""
    if isinstance(node, ast.keyword):
        return node.arg == "callback_group"
    name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
    return name.endswith("CallbackGroup")


def _is_future(function: ast.AsyncFunctionDef, value: ast.expr) -> bool:
    """Return whether the function assigns the future of a request to this variable or attribute."""
    name = dotted(value)
    return name is not None and any(
        isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Call)
        and last_name(node.value) in ASYNCHRONOUS
        and name in map(dotted, node.targets)
        for node in inside(function)
    )


def _where(evidence: Evidence, function: ast.AsyncFunctionDef, node: ast.Await) -> Where | None:
    for module in evidence.code.modules:
        if function in module.nodes:
            return Where(module.file, node.lineno)
    return None

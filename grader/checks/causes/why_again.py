"""Explain why a node calls a service again and again for the same target."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_silent import methods_of
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

CALL = "call_async"
NOTHING = (None, False)
"""The values of an attribute that mean that the node is not waiting for a response."""


def why_again(evidence: Evidence) -> Cause:
    """Return the cause of repeated calls: the node does not wait for the response, or does not forget the target."""
    where = evidence.place(CALL)
    waiting = {name for _, method in methods_of(evidence) if _calls(method) for name, _ in _set(method, empty=False)}
    ended = [
        Where(module.file, line)
        for module, method in methods_of(evidence)
        if method.name != "__init__" and not _calls(method)
        for name, line in _set(method, empty=True)
        if name in waiting & _tested(module)
    ]
    if ended:
        text = (
            "The node already waits for the response. When the response has arrived, the node must also forget the "
            "target. Otherwise, this target is still the nearest one."
        )
        return Cause("catch-again", text, ended[0])
    text = "Store in an attribute whether the node is waiting for a response. While it is waiting, do not call again."
    return Cause("catch-again", text, where)


def _calls(method: ast.FunctionDef) -> bool:
    return any(isinstance(node, ast.Attribute) and node.attr == CALL for node in ast.walk(method))


def _set(method: ast.FunctionDef, *, empty: bool) -> Iterator[tuple[str, int]]:
    """Yield the name and the line of each assignment to an attribute of self in the method.

    With `empty`, only assignments of None or False count. Without `empty`, only assignments of other values count.
    """
    for node in ast.walk(method):
        if isinstance(node, ast.Assign):
            nothing = isinstance(node.value, ast.Constant) and node.value.value in NOTHING
            names = filter(None, map(dotted, node.targets))
            yield from ((name, node.lineno) for name in names if name.startswith("self.") and nothing == empty)


def _tested(module: Module) -> set[str | None]:
    """Return the attributes, such as "self.target", that occur in the conditions of the module."""
    tests = [node.test for node in module.nodes if isinstance(node, ast.If | ast.While | ast.IfExp)]
    return {dotted(each) for test in tests for each in ast.walk(test) if isinstance(each, ast.Attribute)}

"""Explain why a service callback does not change its node: it stores nothing, or uses the whole request as a value."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

Method = ast.FunctionDef | ast.AsyncFunctionDef


def not_stored(evidence: Evidence) -> Cause | None:
    """Return the cause if a service callback stores the request in a local variable or compares it whole, else None."""
    for module, method in _servers(evidence):
        request = _request(method)
        for node in ast.walk(method):
            if not isinstance(node, ast.Compare):
                continue
            sides = (node.left, *node.comparators)
            whole = any(isinstance(side, ast.Name) and side.id == request for side in sides)
            if whole and any(isinstance(getattr(side, "value", None), bool) for side in sides):
                text = f"{request} is the whole request, which never equals True or False. Compare its field data."
                return Cause("pause-ignored", text, Where(module.file, node.lineno))
        local = _local(module, method, request)
        if local is not None:
            return local
    return None


def whole_request(evidence: Evidence) -> Cause | None:
    """Return the cause if a service callback stores or tests the whole request, which always counts as true."""
    for module, method in _servers(evidence):
        request = _request(method)
        for node in ast.walk(method):
            used = getattr(node, "test", None) if isinstance(node, ast.If | ast.IfExp) else None
            if isinstance(node, ast.Assign) and any(_of_self(target) for target in node.targets):
                used = node.value
            if isinstance(used, ast.UnaryOp) and isinstance(used.op, ast.Not):
                used = used.operand
            if isinstance(used, ast.Name) and used.id == request:
                text = f"{request} is the whole request, which always counts as true. Its field data is True or False."
                return Cause("pause-never-ends", text, Where(module.file, used.lineno))
    return None


def _servers(evidence: Evidence) -> Iterator[tuple[Module, Method]]:
    """Yield the functions and methods that are callbacks of services, with their modules."""
    for module, name in callbacks_of(evidence, "create_service"):
        yield from ((module, node) for node in module.nodes if isinstance(node, Method) and node.name == name)


def _request(method: Method) -> str:
    """Return the name of the parameter for the request, or an empty string."""
    names = [each.arg for each in method.args.args if each.arg != "self"]
    return names[0] if names else ""


def _local(module: Module, method: Method, request: str) -> Cause | None:
    """Return the cause if the callback assigns a local variable where another function reads an attribute, else None.

    The same applies to a variable of the module.
    """
    inside = list(ast.walk(method))
    kept = {name for node in inside if isinstance(node, ast.Global | ast.Nonlocal) for name in node.names}
    others = [node for node in module.nodes if node not in inside]
    read_of_self = {_of_self(node) for node in others if not _is_stored(node)}
    attributes = read_of_self - {_of_self(node) for node in inside if _is_stored(node)} - {""}
    globals_ = {name for node in module.body if isinstance(node, ast.Assign) for name in map(dotted, node.targets)}
    read = {node.id for node in others if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    for node in inside:
        names = [dotted(target) or "" for target in node.targets] if isinstance(node, ast.Assign) else []
        if not names or request not in {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}:
            continue
        place = Where(module.file, getattr(node, "lineno", None))
        for name in (each for each in names if each not in kept):
            if name in attributes:
                text = f"This line assigns {shorten(name)} without self, so self.{shorten(name)} keeps its old value."
                return Cause("missing-self", text, place).fixed_by(at(place, f"{name} =", f"self.{name} ="))
            if name in globals_ and name in read:
                text = (
                    f"{shorten(name)} is a local variable of {method.name} here. To change the variable of the module, "
                    f"the function needs the line global {shorten(name)}."
                )
                return Cause("local-name", text, place)
    return None


def _of_self(node: ast.AST) -> str:
    """Return the name of an attribute of self, or an empty string for any other node."""
    own = isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"
    return node.attr if own else ""  # type: ignore[attr-defined]


def _is_stored(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)

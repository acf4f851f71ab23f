"""Explain why a node sends nothing: its methods wait for an attribute that always stays None."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

Held = tuple[ast.ClassDef, ast.FunctionDef]


def never_set(evidence: Evidence, sends: Sequence[str]) -> Cause | None:
    """Return the cause if each method that sends something waits for an attribute that stays None, else None.

    `sends` contains the names of the methods that send something, such as publish, info or call_async.
    """
    modules = evidence.code.modules
    if any(isinstance(node, ast.Name) and node.id == "setattr" for module in modules for node in module.nodes):
        return None
    causes = [_why(evidence, module, held, sends) for module in modules for held in _senders(module, sends)]
    return causes[0] if causes and all(causes) else None


def _senders(module: Module, sends: Sequence[str]) -> Iterator[Held]:
    """Yield each method that sends something, except __init__, with its class."""
    for own in module.nodes:
        if isinstance(own, ast.ClassDef):
            for method in own.body:
                if isinstance(method, ast.FunctionDef) and method.name != "__init__" and _calls(method, sends):
                    yield own, method


def _why(evidence: Evidence, module: Module, held: Held, sends: Sequence[str]) -> Cause | None:
    """Return the cause if the method waits for an attribute that stays None, else None."""
    own, method = held
    for name in _needed(method, sends):
        lines = _set_to_none(evidence, name)
        if not lines:
            continue
        local = _local(own, name)
        if local is not None:
            text = f"Line {local} assigns {shorten(name)} without self, so self.{shorten(name)} stays None."
            return Cause("missing-self", text, Where(module.file, local))
        text = f"self.{shorten(name)} is None at first, and no line gives it another value."
        return Cause("never-logs" if "info" in sends else "never-publishes", text, Where(module.file, lines[0]))
    return None


def _local(own: ast.ClassDef, name: str) -> int | None:
    """Return a line in a method other than __init__ that assigns a local variable with this name, or None."""
    for method in own.body:
        inside = ast.walk(method) if isinstance(method, ast.FunctionDef) and method.name != "__init__" else ()
        for node in inside:
            if isinstance(node, ast.Assign) and name in map(dotted, node.targets):
                return node.lineno
    return None


def _set_to_none(evidence: Evidence, name: str) -> list[int]:
    """Return the lines that assign None to the attribute, or an empty list if a line may assign another value."""
    lines: list[int] = []
    for module in evidence.code.modules:
        for node in module.nodes:
            targets = node.targets if isinstance(node, ast.Assign) else []
            targets = [node.target] if isinstance(node, ast.AnnAssign) and node.value is not None else targets
            none = targets and _is_none(node.value)  # type: ignore[attr-defined]
            lines += [target.lineno for target in targets if none and _attribute(target) == name]
    stores = [
        node
        for module in evidence.code.modules
        for node in module.nodes
        if isinstance(node, ast.Attribute) and node.attr == name and isinstance(node.ctx, ast.Store)
    ]
    return lines if len(stores) == len(lines) else []


def _needed(method: ast.FunctionDef, sends: Sequence[str]) -> Iterator[str]:
    """Yield the attributes of self that must have a value other than None before the method sends anything."""
    for statement in method.body:
        if isinstance(statement, ast.If):
            ends = isinstance(statement.body[-1], ast.Return) and not _calls(statement, sends)
            inside = any(_calls(each, sends) for each in statement.body) and not statement.orelse
            for test in _parts(statement.test, ast.Or if ends else ast.And) if ends or inside else ():
                name = _tested(test, missing=ends)
                if name is not None:
                    yield name
        if _calls(statement, sends):
            return


def _parts(test: ast.expr, operator: type[ast.boolop]) -> list[ast.expr]:
    return test.values if isinstance(test, ast.BoolOp) and isinstance(test.op, operator) else [test]


def _tested(test: ast.expr, *, missing: bool) -> str | None:
    """Return the name of the attribute of self if the test checks that this attribute is not None, else None.

    With `missing`, the test must check that the attribute is None.
    """
    if isinstance(test, ast.Compare) and len(test.ops) == 1 and _is_none(test.comparators[0]):
        wanted = (ast.Is, ast.Eq) if missing else (ast.IsNot, ast.NotEq)
        return _attribute(test.left) if isinstance(test.ops[0], wanted) else None
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return _attribute(test.operand) if missing else None
    return None if missing else _attribute(test)


def _attribute(node: ast.expr) -> str | None:
    """Return the name of an attribute of self, or None for any other expression."""
    return node.attr if isinstance(node, ast.Attribute) and dotted(node) == f"self.{node.attr}" else None


def _is_none(node: ast.expr | None) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _calls(node: ast.AST, names: Sequence[str]) -> bool:
    calls = (each for each in ast.walk(node) if isinstance(each, ast.Call))
    return any(getattr(each.func, "attr", "") in names for each in calls)

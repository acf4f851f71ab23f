"""Find conditions and callbacks in the source that compare or store the wrong thing."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

ROOTS = frozenset({"sqrt", "hypot", "dist", "norm"})
SIGNS: dict[object, str] = {ast.Gt: ">", ast.GtE: ">="}


def _compared(evidence: Evidence) -> Iterator[tuple[Module, ast.Compare]]:
    for module in evidence.code.modules:
        yield from ((module, node) for node in module.nodes if isinstance(node, ast.Compare))


FIELDS: dict[str, tuple[Diagnosis, str]] = {
    "data": ("pause-ignored", "True or False"),
    "status": ("goal-not-sent", "a number. GoalStatus has a constant for each status"),
}
"""Maps a field to the diagnosis if it is compared with a string, and to a phrase for its values."""


def field_and_string(evidence: Evidence, field: str) -> Cause | None:
    """Return the cause if a field that is not a string, such as `status`, is compared with a string, else None."""
    for module, node in _compared(evidence):
        sides = (node.left, *node.comparators)
        strings = [each for each in sides if isinstance(each, ast.Constant) and isinstance(each.value, str)]
        if strings and any(isinstance(each, ast.Attribute) and each.attr == field for each in sides):
            diagnosis, kind = FIELDS[field]
            text = f"This line compares {field} with a string, but {field} is {kind}."
            return Cause(diagnosis, text, Where(module.file, node.lineno))
    return None


def why_from_afar(evidence: Evidence) -> Cause | None:
    """Return the cause if the distance is not a square root, or the comparison with the reach is reversed."""
    for module, method in methods_of(evidence):
        read = {node.attr for node in ast.walk(method) if isinstance(node, ast.Attribute)}
        if method.name == "distance" and "x" in read and "y" not in read:
            text = "The method distance uses x, but not y."
            return Cause("from-afar", text, Where(module.file, method.lineno))
        for node in ast.walk(method):
            value = node.value if isinstance(node, ast.Return) else None
            if "distance" in method.name and value is not None and _is_sum_of_squares(value):
                text = f"{method.name} returns the square of the distance. The square root is missing."
                return Cause("from-afar", text, Where(module.file, getattr(node, "lineno", None)))
    for module, node in _compared(evidence):
        right = dotted(node.comparators[0]) or ""
        sign = SIGNS.get(type(node.ops[0]))
        if sign is not None and "reach" in right.lower() and _is_condition_of_call(module, node):
            text = f"With {sign}, this condition holds while the target is farther away than {shorten(right)}."
            return Cause("from-afar", text, Where(module.file, node.lineno))
    return None


def _is_sum_of_squares(value: ast.expr) -> bool:
    """Return whether an expression adds powers, as in dx**2 + dy**2, and takes no square root."""
    powers = [each for each in ast.walk(value) if isinstance(each, ast.BinOp) and isinstance(each.op, ast.Pow)]
    halves = any(isinstance(each.right, ast.Constant) and each.right.value == 0.5 for each in powers)
    calls = [each.func for each in ast.walk(value) if isinstance(each, ast.Call)]
    called = {getattr(each, "attr", getattr(each, "id", "")) for each in calls}
    added = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add)
    return added and len(powers) >= 2 and not halves and not called & ROOTS


def _is_condition_of_call(module: Module, test: ast.Compare) -> bool:
    """Return whether an if statement with this condition begins by calling a method whose name contains "catch"."""
    for node in module.nodes:
        if isinstance(node, ast.If) and node.test is test:
            return any("catch" in ast.unparse(each).lower() for each in node.body)
    return False


def stored_before_refused(evidence: Evidence) -> Cause | None:
    """Return the cause if the callback for parameters stores new values before it may refuse them, else None."""
    names = {name for _, name in callbacks_of(evidence, "add_on_set_parameters_callback")}
    for module, method in methods_of(evidence):
        refusals = [node.lineno for node in ast.walk(method) if isinstance(node, ast.Return) and _refuses(node)]
        stores = [
            node.lineno
            for node in ast.walk(method)
            if isinstance(node, ast.Assign) and any((dotted(each) or "").startswith("self.") for each in node.targets)
        ]
        if method.name in names and refusals and stores and min(stores) < max(refusals):
            text = f"{method.name} stores new values in self before it refuses them. Check all values first."
            return Cause("parameter-not-followed", text, Where(module.file, min(stores)))
    return None


def _refuses(node: ast.Return) -> bool:
    return "successful=False" in ast.unparse(node)

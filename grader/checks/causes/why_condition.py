"""Find conditions and callbacks in the source that compare or store the wrong thing."""

from __future__ import annotations

import ast
import math
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of
from grader.common.words import shorten
from grader.submission.constants import Names, dotted, number, written
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

ROOTS = frozenset({"sqrt", "hypot", "dist", "norm"})
HALF, SQUARE = 0.5, 2.0
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
    if any(_defines(node, field) for module in evidence.code.modules for node in module.nodes):
        return None
    for module, node in _compared(evidence):
        sides = (node.left, *node.comparators)
        strings = [each for each in sides if isinstance(each, ast.Constant) and isinstance(each.value, str)]
        if strings and any(_is_field(each, field) for each in sides):
            diagnosis, kind = FIELDS[field]
            text = f"This line compares {field} with a string, but {field} is {kind}."
            return Cause(diagnosis, text, Where(module.file, node.lineno))
    return None


def _is_field(side: ast.expr, field: str) -> bool:
    """Return whether the expression is this field of a request or a result. The field `data` is that of a request."""
    if not isinstance(side, ast.Attribute) or side.attr != field:
        return False
    owner = ast.unparse(side.value)
    return owner != "self" and (field != "data" or "req" in owner.lower())


def _defines(node: ast.AST, field: str) -> bool:
    """Return whether the code itself defines or sets an attribute with this name."""
    if isinstance(node, ast.Attribute):
        return node.attr == field and isinstance(node.ctx, ast.Store)
    if isinstance(node, ast.ClassDef):
        named = [getattr(each, "name", "") for each in node.body]
        given = [inner.id for each in node.body for inner in ast.iter_child_nodes(each) if isinstance(inner, ast.Name)]
        return field in (*named, *given)
    return isinstance(node, ast.keyword) and node.arg == field


def why_from_afar(evidence: Evidence, reach_m: float) -> Cause | None:
    """Return the cause if the distance is wrong (no y, no square root), or its comparison with the reach is reversed.

    Return None if the source shows none of these mistakes.
    """
    squares_are_used = _uses_squares(evidence, reach_m)
    for module, method in methods_of(evidence):
        read = {node.attr for node in ast.walk(method) if isinstance(node, ast.Attribute)}
        calls = (node.func for node in ast.walk(method) if isinstance(node, ast.Call))
        helped = any((dotted(each) or "").startswith("self.") for each in calls)
        if method.name == "distance" and "x" in read and "y" not in read and not helped:
            text = "The method distance uses x, but not y."
            return Cause("from-afar", text, Where(module.file, method.lineno))
        for node in ast.walk(method):
            value = written(node.value, module.names) if isinstance(node, ast.Return) else None
            named = "distance" in method.name and "sq" not in method.name
            if named and value is not None and _is_sum_of_squares(value) and not squares_are_used:
                text = f"{method.name} returns the square of the distance. The square root is missing."
                return Cause("from-afar", text, Where(module.file, getattr(node, "lineno", None)))
    for module, node in _compared(evidence):
        right = dotted(node.comparators[0]) or ""
        sign = SIGNS.get(type(node.ops[0]))
        is_reach = right.lower().endswith(("reach", "reach_m"))
        if sign is not None and is_reach and _is_condition_of_call(module, node):
            text = f"With {sign}, this condition holds while the target is farther away than {shorten(right)}."
            return Cause("from-afar", text, Where(module.file, node.lineno))
    return None


def _is_sum_of_squares(value: ast.expr) -> bool:
    """Return whether an expression adds two squares, as in dx**2 + dy*dy, and takes no square root."""
    added = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add)
    return added and all(map(_squares, (value.left, value.right)))  # type: ignore[attr-defined]


def _squares(side: ast.expr) -> bool:
    """Return whether the expression is x ** 2, x * x or pow(x, 2)."""
    if isinstance(side, ast.Call) and (dotted(side.func) or "").rpartition(".")[2] == "pow" and len(side.args) > 1:
        return number(side.args[1], Names()) == SQUARE
    if not isinstance(side, ast.BinOp):
        return False
    if isinstance(side.op, ast.Pow):
        return number(side.right, Names()) == SQUARE
    return isinstance(side.op, ast.Mult) and ast.unparse(side.left) == ast.unparse(side.right)


def _uses_squares(evidence: Evidence, reach_m: float) -> bool:
    """Return whether the code takes a root, or compares a value with a square."""
    for module in evidence.code.modules:
        for node in module.nodes:
            sides = (node.left, *node.comparators) if isinstance(node, ast.Compare) else ()
            if _is_root(node) or any(_is_square(side, module, reach_m) for side in sides):
                return True
    return False


def _is_root(node: ast.AST) -> bool:
    """Return whether the node takes a square root: a function in ROOTS, or a power with the exponent 0.5."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return number(node.right, Names()) == HALF
    name = (dotted(node.func) or "").rpartition(".")[2] if isinstance(node, ast.Call) else ""
    if isinstance(node, ast.Call) and name == "pow" and len(node.args) > 1:
        return number(node.args[1], Names()) == HALF
    return name in ROOTS


def _is_square(side: ast.expr, module: Module, reach_m: float) -> bool:
    """Return whether the expression is a square: a power, x * x, the square of the reach, or a name for one of them.

    A name that contains "sq" counts, too.
    """
    value = written(side, module.names)
    product = isinstance(value, ast.BinOp) and (
        isinstance(value.op, ast.Pow)
        or (
            isinstance(value.op, ast.Mult)
            and dotted(value.left) is not None
            and dotted(value.left) == dotted(value.right)
        )
    )
    squared = number(side, module.names)
    near = squared is not None and math.isclose(squared, reach_m**2)
    return product or near or "sq" in ast.unparse(side).lower()


def _is_condition_of_call(module: Module, test: ast.Compare) -> bool:
    """Return whether this is the condition of an if statement whose first statement calls catch or its client."""
    for node in module.nodes:
        if isinstance(node, ast.If) and node.test is test:
            first = node.body[0]
            call = first.value if isinstance(first, ast.Expr | ast.Assign) else None
            name = (dotted(call.func) or "").lower() if isinstance(call, ast.Call) else ""
            owner, _, last = name.rpartition(".")
            return last.lstrip("_").startswith("catch") or (last == "call_async" and "catch" in owner)
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
            if _may_be_new(node.value)
        ]
        early = [
            store
            for store in stores
            for refusal in refusals
            if store < refusal and not _of_other_names(method, store, refusal) and not _apart(method, store, refusal)
        ]
        if method.name in names and early:
            text = f"{method.name} stores new values in self before it refuses them. Check all values first."
            return Cause("parameter-not-followed", text, Where(module.file, min(early)))
    return None


def _may_be_new(value: ast.expr) -> bool:
    """Return whether a stored value may be that of a parameter. A constant and self.count + 1 are not."""
    return any(isinstance(each, ast.Name) and each.id != "self" for each in ast.walk(value))


def _apart(method: ast.AST, store: int, refusal: int) -> bool:
    """Return whether only one of the two lines runs, because they are in different branches of an if statement."""
    for node in ast.walk(method):
        branches = [node.body, node.orelse] if isinstance(node, ast.If) and node.orelse else []
        held = [
            [each[0].lineno <= line <= (each[-1].end_lineno or 0) for each in branches] for line in (store, refusal)
        ]
        if all(map(any, held)) and held[0] != held[1]:
            return True
    return False


def _of_other_names(method: ast.AST, store: int, refusal: int) -> bool:
    """Return whether these lines are in if statements whose conditions contain the names of different parameters."""
    ifs = [node for node in ast.walk(method) if isinstance(node, ast.If)]
    names = [
        {
            each.value
            for node in ifs
            if node.body[0].lineno <= line <= (node.body[-1].end_lineno or 0)
            for each in ast.walk(node.test)
            if isinstance(each, ast.Constant) and isinstance(each.value, str)
        }
        for line in (store, refusal)
    ]
    return all(names) and names[0].isdisjoint(names[1])


def _refuses(node: ast.Return) -> bool:
    return "successful=False" in ast.unparse(node)

"""Find asserts that nearly always hold, such as an `or` with a constant, or a value compared with itself."""

from __future__ import annotations

import ast
import copy
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.submission.pytest_files import TestCode


TOLERANT = frozenset({"approx", "isclose"})
TOLERANCES = ("rel", "abs", "rel_tol", "abs_tol")
WIDE = 0.3
"""A relative or absolute tolerance from which on the values of a broken node can pass as those of the correct one."""


def vacuous_assert(code: TestCode) -> Cause | None:
    """Return the cause if an assert of a test holds on every node, else None."""
    for test in code.tests:
        for node in ast.walk(test.node):
            if isinstance(node, ast.Assert):
                text = _object(node.test) or _or_constant(node.test) or _never_false(node.test)
                text = text or _with_itself(node.test, _just_assigned(test.node, node.lineno))
                if text is not None:
                    return Cause("assert-vacuous", text, Where(test.module.file, node.lineno))
    return None


def wide_tolerance(code: TestCode) -> Cause | None:
    """Return the cause if pytest.approx or isclose allows a large difference between values, else None.

    A comparison of numbers of messages does not count.
    """
    for module in code.modules:
        compared = [node for node in module.nodes if isinstance(node, ast.Compare) and "len(" in ast.unparse(node)]
        counts = {id(each) for node in compared for each in ast.walk(node)}
        for node in module.nodes:
            wide = _tolerance(node) if isinstance(node, ast.Call) and id(node) not in counts else None
            if wide is not None:
                text = f"{wide} allows so large a difference that wrong values pass. Leave it out."
                return Cause("assert-vacuous", text, Where(module.file, getattr(node, "lineno", None)))
    return None


def _tolerance(call: ast.Call) -> str | None:
    """Return the argument that sets a tolerance of at least WIDE, as text, or None."""
    name = (dotted(call.func) or "").rpartition(".")[2]
    if name not in TOLERANT:
        return None
    given = {each.arg: each.value for each in call.keywords if each.arg in TOLERANCES}
    if name == "approx":
        given.update(zip(("rel", "abs"), call.args[1:], strict=False))
    for argument, value in given.items():
        if isinstance(value, ast.Constant) and isinstance(value.value, int | float) and value.value >= WIDE:
            return f"{argument}={value.value}"
    return None


def value_as_message(code: TestCode) -> Cause | None:
    """Return the cause for an assert such as `assert msg.x, 1.0` or `assert msg.x, SPEED`, else None."""
    for test in code.tests:
        for node in ast.walk(test.node):
            if isinstance(node, ast.Assert) and isinstance(node.test, ast.Attribute) and _is_value(node.msg):
                text = "An assert checks only the part before the comma. To compare two values, write == between them."
                return Cause("assert-vacuous", text, Where(test.module.file, node.lineno))
    return None


def _is_value(message: ast.expr | None) -> bool:
    """Return whether the message of an assert is a number or the name of a constant."""
    number = isinstance(message, ast.Constant) and isinstance(message.value, int | float)
    return number or (isinstance(message, ast.Name) and message.id.isupper())


def _object(condition: ast.expr) -> str | None:
    """Return a sentence about an object that counts as true whatever is in it, or None."""
    if isinstance(condition, ast.List | ast.Set) and condition.elts:
        return "A list or set that is not empty counts as true. Remove the brackets."
    if isinstance(condition, ast.Lambda):
        return "A function counts as true, and this one is never called. Write the condition without lambda."
    if isinstance(condition, ast.GeneratorExp):
        return "A generator counts as true, and nothing runs its condition. Call all(...) or any(...) with it."
    if isinstance(condition, ast.NamedExpr) and isinstance(condition.value, ast.Constant) and condition.value.value:
        return ":= assigns a value, which counts as true. To compare two values, write == between them."
    return None


def _never_false(condition: ast.expr) -> str | None:
    """Return a sentence about a comparison that always holds, or None."""
    if not isinstance(condition, ast.Compare) or len(condition.ops) != 1:
        return None
    left, operator, right = condition.left, condition.ops[0], condition.comparators[0]
    if isinstance(operator, ast.IsNot) and isinstance(right, ast.List | ast.Dict | ast.Set):
        return "is not compares two objects, and a new list is always another object. Write != instead."
    zero = isinstance(right, ast.Constant) and not isinstance(right.value, bool) and right.value == 0
    is_length = isinstance(left, ast.Call) and isinstance(left.func, ast.Name) and left.func.id == "len"
    if is_length and zero and isinstance(operator, ast.GtE):
        return "A length is never less than 0, so the condition always holds. Write the number that you expect."
    return None


def _or_constant(condition: ast.expr) -> str | None:
    """Return a sentence about a constant beside `or` that makes the condition true, or None."""
    if isinstance(condition, ast.BoolOp) and isinstance(condition.op, ast.Or):
        for each in condition.values:
            if isinstance(each, ast.Constant) and each.value:
                shown = shorten(ast.unparse(each), 30)
                return f"{shown} alone counts as true, so the condition always holds. Repeat the comparison after or."
    return None


def _with_itself(condition: ast.expr, names: Mapping[str, ast.expr]) -> str | None:
    """Return a sentence about a value that is compared with itself, or None.

    `names` maps a variable to the expression that was assigned to it.
    """
    if not isinstance(condition, ast.Compare) or len(condition.ops) != 1 or not isinstance(condition.ops[0], ast.Eq):
        return None
    left, right = (_resolved(each, names) for each in (condition.left, condition.comparators[0]))
    if left != right or "(" in left:
        return None
    return "This compares a value with itself. Compare it with the number that the node promises."


def _resolved(value: ast.expr, names: Mapping[str, ast.expr]) -> str:
    """Return the expression as text. A variable is replaced with the expression that was assigned to it."""

    class Replace(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.expr:
            return names.get(node.id, node)

    return ast.unparse(Replace().visit(copy.deepcopy(value)))


def _just_assigned(test: ast.AST, line: int) -> dict[str, ast.expr]:
    """Return the variables that are assigned before a line, with their values, if no call is in between.

    After a call, the assigned expression may have another value. A call on the line of the assignment also counts, but
    a call in an assert does not.
    """
    asserts = [node for node in ast.walk(test) if isinstance(node, ast.Assert)]
    harmless = {id(each) for node in asserts for each in ast.walk(node)}
    calls = [node.lineno for node in ast.walk(test) if isinstance(node, ast.Call) and id(node) not in harmless]
    return {
        target.id: node.value
        for node in ast.walk(test)
        if isinstance(node, ast.Assign) and not any(node.lineno <= each < line for each in calls)
        for target in node.targets
        if isinstance(target, ast.Name) and node.lineno < line
    }

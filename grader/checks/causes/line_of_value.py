"""Find the line that contains the value of a message field: a constant, or a call to a helper function."""

from __future__ import annotations

import ast
import math
import re
from typing import TYPE_CHECKING

from grader.submission.constants import dotted, number, written
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call, Module

Function = ast.FunctionDef | ast.AsyncFunctionDef
OTHER_FIELD = {
    "linear": re.compile("ang|turn|rot|yaw|omega|steer", re.IGNORECASE),
    "angular": re.compile("lin|forw|drive|speed$", re.IGNORECASE),
}
"""Maps a part of a Twist to a pattern for the names of variables that belong in the other part.

If such a variable is assigned to a field, the mistake is in the assignment, not in the value of the variable."""


def line_of_value(evidence: Evidence, field: str, value: float) -> Where | None:
    """Return the line from which a field such as "linear.x" gets this value, or None.

    The value must reach the field through a named constant, or through an argument of a function that sets the field.
    If the number itself is assigned to the field, or if several lines fit, return None.
    """
    assigned = list(_assigned(evidence, field))
    other = OTHER_FIELD[field.partition(".")[0]]
    if any(other.search((dotted(given) or "").rpartition(".")[2]) for _, given in assigned):
        return None
    found = {place for module, given in assigned for place in _places(evidence, module, given, value)}
    return found.pop() if len(found) == 1 else None


def _assigned(evidence: Evidence, field: str) -> Iterator[tuple[Module, ast.expr]]:
    """Yield the expressions that are assigned to the field, with their modules."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Assign) and any(f".{dotted(each)}".endswith(f".{field}") for each in node.targets):
                yield module, node.value


def _places(evidence: Evidence, module: Module, given: ast.expr, value: float) -> Iterator[Where]:
    if not isinstance(given, ast.Name | ast.Attribute):
        return
    arguments = list(_arguments(evidence, module, given))
    for where, expression in arguments or [(module, given)]:
        constant = written(expression, where.names)
        result = number(constant, where.names)
        if constant is not None and constant is not given and result is not None and math.isclose(result, value):
            yield Where(where.file, constant.lineno)


def _arguments(evidence: Evidence, module: Module, given: ast.expr) -> Iterator[tuple[Module, ast.expr]]:
    """If the expression is a parameter of the function that contains it, yield the arguments for this parameter."""
    around = [
        node for node in module.nodes if isinstance(node, Function) and any(each is given for each in ast.walk(node))
    ]
    for function in around[-1:]:
        names = [each.arg for each in (*function.args.posonlyargs, *function.args.args)]
        if isinstance(given, ast.Name) and given.id in names:
            place = names.index(given.id) - (names[0] == "self")
            calls: list[Call] = evidence.code.calls(function.name)
            passed = ((call.module, call.argument(place, given.id)) for call in calls)
            yield from ((of, argument) for of, argument in passed if argument is not None)

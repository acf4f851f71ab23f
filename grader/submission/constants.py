"""Evaluate constants in a source file without running it: numbers, strings, and names with such values."""

from __future__ import annotations

import ast
import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

Constant = str | float | int


class Names(dict[str, "ast.expr | None"]):
    """The assigned names with their expressions, and a limit on the work of evaluating them.

    In `x = y + y; y = z + z; ...`, each line doubles the work. Therefore, the number of syntax nodes that are evaluated
    for each module is limited.
    """

    def __init__(self) -> None:
        super().__init__()
        self._left = MAX_NODES

    def spend(self) -> bool:
        """Count one more node of the syntax tree. Return False if the limit is exceeded."""
        self._left -= 1
        return self._left >= 0


MAX_DEPTH = 20
MAX_NODES = 100_000
"""The maximum number of syntax nodes that are evaluated in one module. Their evaluation takes about 0.1 s. The values
of all further nodes are unknown."""
MAX_TEXT = 2000
MATH = {"math.pi": math.pi, "pi": math.pi, "np.pi": math.pi, "numpy.pi": math.pi, "math.tau": math.tau}


def dotted(node: ast.expr) -> str | None:
    """Return a name or attribute such as 'self.period' as a string, or None for any other expression."""
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if not isinstance(node, ast.Name):
        return None
    return ".".join([node.id, *reversed(parts)])


def single_names(tree: ast.AST) -> Names:
    """Map each assigned name or attribute to the expression that is assigned to it.

    The value is None if the name is assigned several times, by a loop or by an operator such as `+=`, or is annotated
    without a value. Names that are assigned as a tuple are left out.
    """
    names = Names()
    for node in ast.walk(tree):
        targets: list[ast.expr] = []
        value: ast.expr | None = None
        if isinstance(node, ast.Assign):
            targets, value = node.targets, node.value
        elif isinstance(node, ast.AnnAssign):
            targets, value = [node.target], node.value
        elif isinstance(node, ast.AugAssign | ast.For):
            targets = [node.target]
        for target in targets:
            name = dotted(target)
            if name is not None:
                names[name] = None if name in names else value
    return names


def written(node: ast.expr | None, names: Names) -> ast.expr | None:
    """Return the expression that is assigned to the name `node`, or `node` itself if there is no such expression."""
    for _ in range(MAX_DEPTH):
        value = names.get(dotted(node) or "") if isinstance(node, ast.Name | ast.Attribute) else None
        if value is None:
            break
        node = value
    return node


def evaluate(node: ast.expr | None, names: Names, depth: int = 0) -> Constant | None:
    """Return the value of the expression, a number or a string, or None if it is not constant."""
    if node is None or depth > MAX_DEPTH or not names.spend():
        return None
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str | int | float) else None
    if isinstance(node, ast.Name | ast.Attribute):
        name = dotted(node)
        if name in MATH:
            return MATH[name]
        return evaluate(names.get(name), names, depth + 1) if name is not None else None
    if isinstance(node, ast.UnaryOp):
        value = evaluate(node.operand, names, depth + 1)
        return -value if isinstance(node.op, ast.USub) and isinstance(value, int | float) else None
    if isinstance(node, ast.BinOp):
        return _binary(node.op, evaluate(node.left, names, depth + 1), evaluate(node.right, names, depth + 1))
    if isinstance(node, ast.JoinedStr):
        return _joined(node, names, depth)
    return _call(node, names, depth)


def number(node: ast.expr | None, names: Names) -> float | None:
    """Return the value of the expression as a finite number, or None if it is not a constant number."""
    value = evaluate(node, names)
    try:
        return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
    except OverflowError:
        return None


def _binary(op: ast.operator, left: Constant | None, right: Constant | None) -> Constant | None:
    if isinstance(left, str) and isinstance(right, str):
        return left + right if isinstance(op, ast.Add) and len(left) + len(right) <= MAX_TEXT else None
    if not isinstance(left, int | float) or not isinstance(right, int | float):
        return None
    try:
        if isinstance(op, ast.Add):
            return float(left) + right
        if isinstance(op, ast.Sub):
            return float(left) - right
        if isinstance(op, ast.Mult):
            return float(left) * right
        if isinstance(op, ast.FloorDiv):
            return float(left) // right
        return float(left) / right if isinstance(op, ast.Div) else None
    except (ArithmeticError, ValueError):
        return None


def _joined(node: ast.JoinedStr, names: Names, depth: int) -> str | None:
    pieces = (piece.value if isinstance(piece, ast.FormattedValue) else piece for piece in node.values)
    return _together("", pieces, names, depth)


def _together(between: str, pieces: Iterable[ast.expr], names: Names, depth: int) -> str | None:
    """Return the joined strings, or None if one of them is not a string or the result is too long."""
    parts: list[str] = []
    length = 0
    for piece in pieces:
        value = evaluate(piece, names, depth + 1)
        if not isinstance(value, str) or length > MAX_TEXT:
            return None
        parts.append(value)
        length += len(value) + len(between)
    return between.join(parts) if length <= MAX_TEXT else None


def _call(node: ast.expr, names: Names, depth: int) -> str | None:
    """Evaluate a call to os.path.join, which is common in setup.py. Return None for any other expression."""
    if not isinstance(node, ast.Call) or dotted(node.func) not in ("os.path.join", "path.join", "join"):
        return None
    return _together("/", node.args, names, depth)

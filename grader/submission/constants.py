"""Evaluate the constants of a student's source without running it: numbers, texts, and names that stand for one."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping

Constant = str | float | int
Names = Mapping[str, "ast.expr | None"]

MAX_DEPTH = 20
MAX_TEXT = 2000
MATH = {"math.pi": math.pi, "pi": math.pi, "np.pi": math.pi, "numpy.pi": math.pi, "math.tau": math.tau}


def dotted(node: ast.expr) -> str | None:
    """'self.period' for such an attribute or name; None for anything else."""
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if not isinstance(node, ast.Name):
        return None
    return ".".join([node.id, *reversed(parts)])


def single_names(tree: ast.AST) -> dict[str, ast.expr | None]:
    """Every name or attribute that is assigned to, with its expression; None when that happens more than once."""
    names: dict[str, ast.expr | None] = {}
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


def evaluate(node: ast.expr | None, names: Names, depth: int = 0) -> Constant | None:
    """The number or text that the expression always is; None when that cannot be told."""
    if node is None or depth > MAX_DEPTH:
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
    """The finite number that the expression always is; None when that cannot be told."""
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
        return float(left) / right if isinstance(op, ast.Div) else None
    except (ArithmeticError, ValueError):
        return None


def _joined(node: ast.JoinedStr, names: Names, depth: int) -> str | None:
    parts: list[str] = []
    for piece in node.values:
        inner = piece.value if isinstance(piece, ast.FormattedValue) else piece
        value = evaluate(inner, names, depth + 1)
        if not isinstance(value, str):
            return None
        parts.append(value)
    whole = "".join(parts)
    return whole if len(whole) <= MAX_TEXT else None


def _call(node: ast.expr, names: Names, depth: int) -> str | None:
    """os.path.join of texts: common in setup.py."""
    if not isinstance(node, ast.Call) or dotted(node.func) not in ("os.path.join", "path.join", "join"):
        return None
    parts = [evaluate(argument, names, depth + 1) for argument in node.args]
    return "/".join(str(part) for part in parts) if all(isinstance(part, str) for part in parts) else None

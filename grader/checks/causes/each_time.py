"""Find what runs each time a function runs: code outside of branches, of conditional expressions and of lambdas."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ENDS = ast.Return | ast.Raise | ast.Continue | ast.Break


def each_time(body: Iterable[ast.stmt]) -> Iterator[ast.AST]:
    """Yield the syntax nodes that run each time these statements run. A for loop is assumed to run at least once."""
    for statement in body:
        if isinstance(statement, ast.With | ast.For):
            yield from each_time(statement.body)
        elif isinstance(statement, ast.Try):
            yield from each_time((*statement.body, *statement.finalbody))
        elif not isinstance(statement, ast.If | ast.While | ast.Match | ast.FunctionDef | ast.ClassDef):
            yield from evaluated(statement)
        if any(isinstance(each, ENDS) for each in ast.walk(statement)):
            return


def evaluated(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the node and the nodes in it, except those that run only in some cases: `x or y` may leave out y."""
    yield node
    if isinstance(node, ast.IfExp):
        parts: Iterable[ast.AST] = [node.test]
    elif isinstance(node, ast.BoolOp):
        parts = node.values[:1]
    else:
        parts = [] if isinstance(node, ast.Lambda) else ast.iter_child_nodes(node)
    for each in parts:
        yield from evaluated(each)

"""Explain why a function returned a value although it must raise an exception."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def why_no_error(evidence: Evidence) -> Cause:
    """Return the cause: the exception is created but not raised, its line is not reached, or none is created."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Return) and _is_error(node.value):
                text = "return passes the exception to the caller like any other value. Write raise instead of return."
                return Cause("no-error", text, Where(module.file, node.lineno))
            if isinstance(node, ast.Expr) and _is_error(node.value):
                text = "This line creates an exception but does not raise it. Write raise before the exception."
                return Cause("no-error", text, Where(module.file, node.lineno))
    where = evidence.place("ValueError", "lstsq", "solve")
    if evidence.code.calls("ValueError"):
        return Cause("no-error", "For these points, the function does not reach the line with ValueError.", where)
    text = "The function raises no exception for these points. A printed message, NaN or None is not an exception."
    return Cause("no-error", text, where)


def _is_error(value: ast.expr | None) -> bool:
    name = dotted(value.func if isinstance(value, ast.Call) else value) if value is not None else None
    return name is not None and name.endswith("Error")

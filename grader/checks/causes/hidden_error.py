"""Find code that hides every error, so that neither the student nor the report sees why the node does nothing."""

from __future__ import annotations

import ast
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.handlers import EVERY_ERROR, caught, suppressed
from grader.checks.causes.why_silent import calls_method
from grader.checks.certain import FACTS, ON_EVERY_MACHINE
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence

CLEANUP = {"destroy_node", "shutdown", "try_shutdown", "destroy", "cancel", "close", "join"}
"""Errors of these calls do not change what the node does, so a program may ignore them."""


def hidden_error(evidence: Evidence, call: str) -> Cause | None:
    """Return the cause if `call` is in a block whose errors are all hidden, else None."""
    for where, body in _hiding(evidence):
        if any(calls_method(each, call) for each in body):
            text = f"This line hides every error. An error before {call} may be the reason."
            return Cause("never-publishes", text, where)
    return None


def with_hidden_error(finding: Finding, evidence: Evidence) -> Finding:
    """Return the failed finding; if its cause is only a possibility, its text also names a line that hides errors.

    If several lines hide errors, the text names the one that is nearest to the place of the finding. Without a cause,
    this line is the place.
    """
    if finding.diagnosis in FACTS | ON_EVERY_MACHINE or finding.fix:
        return finding
    lines = [where for where, _ in _hiding(evidence)]
    if not lines or finding.where in lines:
        return finding
    where = min(lines, key=lambda each: _distance(each, finding.where))
    if not finding.cause:
        return replace(finding, cause="This line may hide an error. Print the error to see it.", where=where)
    place = f"line {where.line}" if finding.where and finding.where.file == where.file else str(where)
    return replace(finding, cause=f"{finding.cause} Perhaps {place} hides an error: print it.")


def _distance(one: Where, other: Where | None) -> int:
    if other is None or one.file != other.file:
        return 10**6
    return abs((one.line or 0) - (other.line or 0))


def _hiding(evidence: Evidence) -> Iterator[tuple[Where, Sequence[ast.stmt]]]:
    """Yield each line that hides every error of a block of statements, and the statements of that block."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Try) and not _is_cleanup(node.body):
                yield from ((Where(module.file, each.lineno), node.body) for each in node.handlers if _hides(each))
            elif (
                isinstance(node, ast.With)
                and any(suppressed(item.context_expr) & EVERY_ERROR for item in node.items)
                and not _is_cleanup(node.body)
            ):
                yield Where(module.file, node.lineno), node.body


def _hides(handler: ast.ExceptHandler) -> bool:
    """Return whether the except clause catches every error and neither reports it nor raises it again."""
    silent = not any(isinstance(each, ast.Call | ast.Raise) for each in ast.walk(handler))
    return silent and bool(caught(handler) & EVERY_ERROR)


def _is_cleanup(body: Sequence[ast.stmt]) -> bool:
    calls = {
        getattr(node.func, "attr", getattr(node.func, "id", ""))
        for statement in body
        for node in ast.walk(statement)
        if isinstance(node, ast.Call)
    }
    return bool(calls) and calls <= CLEANUP

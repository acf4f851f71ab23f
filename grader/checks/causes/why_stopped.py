"""Explain why commands or log lines stop before the end, for example because a timer is cancelled."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.causes.crash import ended_early
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

CANCELS = "cancel stops the timer, so the timer does not call its method again."


def cancelled(evidence: Evidence) -> Where | None:
    """Return the place where a node with timers calls a method named cancel, or None."""
    if evidence.code.calls("create_timer") and evidence.code.calls("cancel"):
        return evidence.place("cancel")
    return None


def why_stopped(evidence: Evidence, call: str) -> tuple[str, Where | None]:
    """Return the reason why `call` is no longer called (or an empty string), and a place in the code (or None)."""
    stop = cancelled(evidence)
    early = ended_early(evidence)
    if early or stop is not None:
        return early or CANCELS, stop
    condition = _condition(evidence, call)
    if condition is None:
        return "", None
    return f"{call} is called only if the condition on line {condition.line} is true.", condition


def _condition(evidence: Evidence, call: str) -> Where | None:
    """Return the innermost if statement whose body contains the only call to `call`, or None."""
    calls = evidence.code.calls(call)
    if len(calls) != 1:
        return None
    around = [
        node
        for node in calls[0].module.nodes
        if isinstance(node, ast.If) and any(calls[0].node in ast.walk(each) for each in node.body)
    ]
    inner = max(around, key=lambda node: node.lineno, default=None)
    return None if inner is None else Where(calls[0].module.file, inner.lineno)

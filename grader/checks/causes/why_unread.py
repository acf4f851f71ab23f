"""Explain why nothing happens after a goal was sent: the node asks for the result, but nothing reads the future."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

ASKS = "get_result_async"


def why_unread(evidence: Evidence) -> Cause | None:
    """Return the cause if nothing reads any future that get_result_async returned, else None."""
    calls = evidence.code.calls(ASKS)
    if not calls or not all(_is_unread(call) for call in calls):
        return None
    text = f"{ASKS} returns a future, and nothing reads this future. Pass a method to its add_done_callback."
    return Cause("goal-not-sent", text, evidence.place(ASKS))


def _is_unread(call: Call) -> bool:
    """Return whether the call is a whole statement, or is assigned to a name that is not read anywhere."""
    for node in call.module.nodes:
        if isinstance(node, ast.Expr) and node.value is call.node:
            return True
        if isinstance(node, ast.Assign) and node.value is call.node:
            names = {dotted(target) for target in node.targets}
            return not any(
                isinstance(each, ast.Name | ast.Attribute) and isinstance(each.ctx, ast.Load) and dotted(each) in names
                for each in call.module.nodes
            )
    return False

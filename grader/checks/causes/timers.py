"""Why a timer never calls its callback, if the source code shows it."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.submission.constants import number

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def timer_fault(evidence: Evidence) -> Cause | None:
    """Return the cause for the first timer that waits too long or has no callback, or None."""
    for timer in evidence.code.calls("create_timer"):
        period = number(timer.argument(0, "timer_period_sec"), timer.module.names)
        if period is not None and period >= evidence.recording.duration_s:
            text = f"The timer waits {period:g} s before its first call. The period is in seconds, not milliseconds."
            return Cause("timer-milliseconds", text, timer.where)
        if _is_call(timer.argument(1, "callback")):
            text = (
                "create_timer needs the method itself. "
                "With () after its name, it gets only the return value of the method."
            )
            return Cause("callback-called", text, timer.where)
    return None


def _is_call(argument: ast.expr | None) -> bool:
    return isinstance(argument, ast.Call) and not ast.unparse(argument.func).endswith(("partial", "callback"))

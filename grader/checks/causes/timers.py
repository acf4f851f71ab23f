"""Why a timer never calls its callback, if the source code shows it."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.submission.constants import number

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where


@dataclass(frozen=True)
class TimerFault:
    """Why a timer never calls its callback: the diagnosis, the cause in words, and the place."""

    diagnosis: str
    cause: str
    where: Where


def timer_fault(evidence: Evidence) -> TimerFault | None:
    """Return the fault of the first timer that waits too long or has no callback, or None."""
    for timer in evidence.code.calls("create_timer"):
        period = number(timer.argument(0, "timer_period_sec"), timer.module.names)
        if period is not None and period >= evidence.recording.duration_s:
            cause = f"The timer waits {period:g} s before its first call. The period is in seconds, not milliseconds."
            return TimerFault("timer-milliseconds", cause, timer.where)
        if _is_call(timer.argument(1, "callback")):
            cause = (
                "create_timer needs the method itself. "
                "With () after its name, it gets only the return value of the method."
            )
            return TimerFault("callback-called", cause, timer.where)
    return None


def _is_call(argument: ast.expr | None) -> bool:
    return isinstance(argument, ast.Call) and not ast.unparse(argument.func).endswith(("partial", "callback"))

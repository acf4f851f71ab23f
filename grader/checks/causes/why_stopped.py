"""Explain why commands or log lines stop before the end, for example because a timer is cancelled."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.causes.callback_code import functions_in_callbacks, inside
from grader.checks.causes.why_rate import may_send
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

CANCELS = "cancel stops the timer, so the timer does not call its method again."
EXIT_S = 1.0
"""The maximum time (s) from the call that ends a program to the exit of the program."""


def cancelled(evidence: Evidence, call: str) -> Where | None:
    """Return the place where a callback cancels a timer that may call `call`, or None.

    A timer that is reset later does not count.
    """
    timers = _named_timers(evidence)
    reset = {_owner(each) for each in evidence.code.calls("reset")}
    run = {id(node) for _, function in functions_in_callbacks(evidence.code.modules) for node in inside(function)}
    for cancel in evidence.code.calls("cancel"):
        timer = timers.get(_owner(cancel))
        if timer is None or id(cancel.node) not in run or _owner(cancel) in reset:
            continue
        if may_send(timer, call) or not evidence.code.calls(call):
            return cancel.where
    return None


def _named_timers(evidence: Evidence) -> dict[str, Call]:
    """Return the calls that create a timer, with the variables to which the timers are assigned."""
    made = {id(each.node): each for each in evidence.code.calls("create_timer")}
    return {
        dotted(target) or "": made[id(node.value)]
        for module in evidence.code.modules
        for node in module.nodes
        if isinstance(node, ast.Assign | ast.AnnAssign) and id(node.value) in made
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
    }


def _owner(call: Call) -> str:
    """Return the variable whose method is called, such as "self.timer", or an empty string."""
    return (dotted(call.node.func) or "").rpartition(".")[0]


def stopped_by_exit(evidence: Evidence, last_s: float, period_s: float) -> bool:
    """Return whether the node exited before the end of the scenario, and before it missed a message.

    The last message arrived at `last_s` (s), and the next one would have been due after `period_s` (s). If the node
    exited much later, it had stopped sending for another reason. A node that used up a resource may have been busy
    since its last message.
    """
    end = evidence.recording.end
    return end.out_of is not None or (end.by == "itself" and end.t_s - last_s <= period_s + EXIT_S)


def why_stopped(evidence: Evidence, call: str) -> tuple[str, Where | None]:
    """Return the reason why a running node no longer calls `call` (or an empty string), and a place (or None)."""
    stop = cancelled(evidence, call)
    if stop is not None:
        return CANCELS, stop
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

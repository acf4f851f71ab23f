"""Explain why messages arrive at the wrong mean rate, for example because a timer has the wrong period."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import long_wait_in_callback
from grader.checks.causes.why_rate import (
    callbacks_of,
    may_send,
    reaches,
    why_several_calls,
)
from grader.checks.causes.why_silent import calls_method
from grader.checks.causes.why_sleep import is_repeated, why_sleep_in_callback
from grader.checks.edit import at
from grader.submission.constants import dotted, written
from grader.submission.constants import number as constant
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.edit import Edit
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

SAME = 0.1
"""A number in the source explains a measured interval if the two differ by at most this fraction of the interval."""

FEWEST_CALLS, MOST_CALLS = 2, 20
"""The range of n for a callback that counts its calls and sends a message only on every n-th call."""

PERIOD = "The first argument of create_timer is the timer period in seconds."


def why_mean(evidence: Evidence, noun: str, call: str, mean: float, rate_hz: float) -> Cause:
    """Return the cause of a wrong mean interval between two messages.

    Args:
        evidence: everything that is known about the submission.
        noun: the name of the messages, such as "command".
        call: the method that the student's code calls to send them, such as "publish".
        mean: the measured mean interval (s).
        rate_hz: the rate that the exercise requires (Hz).
    """
    why = _why_mean(evidence, noun, call, mean, rate_hz)
    return _period_cause(why, mean, rate_hz) if why.diagnosis == "timer-period" else why


def why_slow_timer(evidence: Evidence, call: str, rate_hz: float, amount: int) -> Cause | None:
    """Return the cause if a timer that calls `call` is so slow that only about `amount` messages arrive, else None."""
    for timer, period in _timers(evidence, call):
        if period is not None and abs(evidence.recording.duration_s / period - amount) <= 1.0:
            why = Cause("timer-period", PERIOD, timer.where).fixed_by(_right_period(timer, rate_hz))
            return _period_cause(why, period, rate_hz)
    return None


def _why_mean(evidence: Evidence, noun: str, call: str, mean: float, rate_hz: float) -> Cause:
    """Return the cause of a wrong mean rate, for example a timer or a sleep with a wrong period."""
    code = evidence.code
    timers = _timers(evidence, call)
    for timer, period in timers:
        if period is not None and abs(period - mean) <= SAME * mean:
            return Cause("timer-period", PERIOD, timer.where).fixed_by(_right_period(timer, rate_hz))
    shortest = min([1.0 / rate_hz, *(period for _, period in timers if period)])
    delays = why_sleep_in_callback(evidence, shortest) or long_wait_in_callback(evidence, shortest)
    if delays is not None and mean * rate_hz > 1.0:
        return delays
    for sleep in code.calls("sleep"):
        length = constant(sleep.argument(0, "secs"), sleep.module.names)
        if length is not None and abs(length - mean) <= SAME * mean and is_repeated(sleep):
            return Cause("sleep-period", f"The node sleeps for {length:g} s between two {noun}s.", sleep.where)
    several = why_several_calls(evidence, call, mean, 1.0 / rate_hz)
    if several is not None:
        return several
    if len(timers) > 1:
        return Cause(
            "several-timers",
            f"There are {len(code.calls('create_timer'))} timers. Each timer calls its method at its own rate.",
            timers[1][0].where,
        )
    counted = _every_few_calls(evidence, noun, call, mean) if len(timers) == 1 else None
    if counted is not None:
        return counted
    if timers and timers[0][1] is None and _sends_each_time(evidence, call):
        return Cause("timer-period", PERIOD, timers[0][0].where)
    where = timers[0][0].where if timers else evidence.place(call)
    return Cause("wrong-rate", f"The time between two calls to {call} sets the rate.", where)


def _every_few_calls(evidence: Evidence, noun: str, call: str, mean: float) -> Cause | None:
    """Return the cause if the callback of the only timer sends only on every 2nd, 3rd, ... call, else None."""
    timer, period = _timers(evidence, call)[0]
    if not period or _sends_each_time(evidence, call):
        return None
    calls = round(mean / period)
    name = (dotted(timer.argument(1, "callback") or ast.Constant(0)) or "").rpartition(".")[2]
    senders = [
        each.name
        for each in timer.module.nodes
        if isinstance(each, ast.FunctionDef) and reaches(timer.module, each, call)
    ]
    others = {other for _, other in callbacks_of(evidence)}
    if (
        name not in senders
        or others & set(senders)
        or not FEWEST_CALLS <= calls <= MOST_CALLS
        or abs(mean - calls * period) > SAME * period
    ):
        return None
    text = f"{name} is called every {period:g} s, and one in {calls} calls sends a {noun}."
    return Cause("wrong-rate", text, timer.where)


def _period_cause(cause: Cause, period: float, rate_hz: float) -> Cause:
    """Return the cause of a wrong timer period, for example that the rate was passed instead of the period."""
    if abs(period - rate_hz) > SAME * rate_hz:
        return cause
    text = "create_timer takes the period in seconds, not the rate. The period is 1 divided by the rate."
    return Cause("rate-for-period", text, cause.where, cause.fix)


def _right_period(timer: Call, rate_hz: float) -> tuple[Edit, ...]:
    """Return the edit that writes the right period into the source, or no edit if the call has no argument for it."""
    node = written(timer.argument(0, "timer_period_sec"), timer.module.names)
    if node is None:
        return ()
    return at(Where(timer.module.file, node.lineno), ast.unparse(node), f"{1.0 / rate_hz:g}")


def _timers(evidence: Evidence, call: str) -> list[tuple[Call, float | None]]:
    """Return the timers whose callback may call `call`, each with the period (s) if the period is a constant.

    If nothing calls `call`, the node sends in some other way, and each timer may be the reason.
    """
    made = evidence.code.calls("create_timer")
    if evidence.code.calls(call):
        made = [timer for timer in made if may_send(timer, call)]
    return [(timer, constant(timer.argument(0, "timer_period_sec"), timer.module.names)) for timer in made]


def _sends_each_time(evidence: Evidence, call: str) -> bool:
    """Return whether the callback of a timer calls `call` once, and not in a branch or a loop."""
    for module, name in callbacks_of(evidence, "create_timer"):
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef) and node.name == name:
                statements = [each for each in node.body if isinstance(each, ast.Expr) and calls_method(each, call)]
                if len(statements) == 1 and sum(calls_method(each, call) for each in node.body) == 1:
                    return True
    return False

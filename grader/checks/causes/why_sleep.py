"""Explain why a node that sleeps sends too rarely: a callback sleeps, or the node sleeps with a Rate."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import has_threads
from grader.checks.causes.why_rate import length_of, made_in_callback, named
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

ONCE = ("__init__", "main")
"""Functions that run once."""


def why_sleep_in_callback(evidence: Evidence, period_s: float) -> Cause | None:
    """Return the cause if a callback sleeps for at least a period (s) in all, or sleeps in a loop, else None.

    Only sleeps whose length is known from the source count.
    """
    found = made_in_callback(evidence, "sleep")
    if found is None:
        return None
    name, where = found
    sleeps = [
        (call, length_of(call))
        for call in evidence.code.calls("sleep")
        if call.where.file == where.file and any(call.node in ast.walk(each) for each in named(call.module, name))
    ]
    in_all_s = sum(length or 0.0 for _, length in sleeps)
    if in_all_s < period_s and not any(length and _in_loop(call) for call, length in sleeps):
        return None
    text = "While a method sleeps, a node with one thread does nothing else."
    return Cause("sleep-in-callback", text, where)


def why_rate_in_callback(evidence: Evidence) -> Cause | None:
    """Return the cause if a node with one thread sleeps with a Rate, in a callback or elsewhere, else None."""
    if not evidence.code.calls("create_rate"):
        return None
    found = made_in_callback(evidence, "sleep")
    if has_threads(evidence) or found is None or found[1] not in [sleep.where for sleep in _sleeps_of_rates(evidence)]:
        return _rate_without_spin(evidence)
    text = (
        "The method sleep of a Rate returns only after rclpy.spin has called the timer of the Rate, "
        "but rclpy.spin waits for this callback."
    )
    return Cause("sleep-in-callback", text, found[1])


def _rate_without_spin(evidence: Evidence) -> Cause | None:
    """Return the cause if the node sleeps with a Rate, but no other thread can spin the node, else None."""
    if has_threads(evidence):
        return None
    for sleep in _sleeps_of_rates(evidence):
        text = (
            "The method sleep of a Rate returns only while another thread spins the node, and this program has no "
            "other thread. A timer does not need an additional thread."
        )
        return Cause("no-spin", text, sleep.where)
    return None


def _sleeps_of_rates(evidence: Evidence) -> list[Call]:
    """Return the calls to a method named sleep without an argument, such as that of a Rate."""
    calls = evidence.code.calls("sleep")
    return [call for call in calls if dotted(call.node.func) not in (None, "sleep") and not call.node.args]


def is_repeated(call: Call) -> bool:
    """Return whether a call is in a loop, or in a function that may be called again and again."""
    functions = (each for each in call.module.nodes if isinstance(each, ast.FunctionDef) and each.name not in ONCE)
    return _in_loop(call) or any(call.node in ast.walk(each) for each in functions)


def _in_loop(call: Call) -> bool:
    loops = (each for each in call.module.nodes if isinstance(each, ast.While | ast.For))
    return any(call.node in ast.walk(each) for each in loops)

"""Explain why a node that sleeps sends too rarely: a callback sleeps, or the node sleeps with a Rate."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import has_threads
from grader.checks.causes.why_rate import length_of, made_in_callback, named
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

ONCE = ("__init__", "main")
"""Functions that run once."""
_LEAVES = (ast.Return, ast.Raise, ast.Continue, ast.Break)
_LATER = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)
"""The code inside these does not run where it is written."""


def why_sleep_in_callback(evidence: Evidence, period_s: float) -> Cause | None:
    """Return the cause if a callback sleeps for at least a period (s) in all, or sleeps in a loop, else None.

    Only sleeps whose length is known from the source count.
    """
    found = made_in_callback(evidence, "sleep")
    if found is None:
        return None
    name, where = found
    sleeps = [
        (call, length_of(call) or 0.0)
        for call in evidence.code.calls("sleep")
        if call.where.file == where.file and any(call.node in ast.walk(each) for each in named(call.module, name))
    ]
    lengths = {id(call.node): length_s for call, length_s in sleeps}
    callbacks = [each for call, _ in sleeps for each in named(call.module, name)]
    longest_s = max((_longest_s(each.body, lengths) for each in callbacks), default=0.0)
    if longest_s < period_s and not any(length_s and _in_loop(call) for call, length_s in sleeps):
        return None
    text = "While a method sleeps, a node with one thread does nothing else."
    return Cause("sleep-in-callback", text, where)


def _longest_s(statements: Sequence[ast.AST], lengths: Mapping[int, float]) -> float:
    """Return the time (s) for which one run of these statements can sleep. `lengths` maps the id of a call to its time.

    Only one branch of an `if` runs. After a branch that ends with return, raise, continue or break, nothing else runs.
    """
    longest_s = 0.0
    for node in reversed(statements):
        if isinstance(node, ast.If):
            taken, other = (
                _longest_s(branch, lengths) + (0.0 if branch and isinstance(branch[-1], _LEAVES) else longest_s)
                for branch in (node.body, node.orelse)
            )
            longest_s = max(taken, other)
        else:
            children = [] if isinstance(node, _LATER) else list(ast.iter_child_nodes(node))
            longest_s += lengths.get(id(node), 0.0) + _longest_s(children, lengths)
    return longest_s


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

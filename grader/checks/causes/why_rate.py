"""Why something comes far too often, or ever more often: loops, callbacks of messages, timers made again and again."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.causes.cause import Cause
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

OFTEN = 0.5
"""A loop that waits for nothing goes at least so much faster than what is asked for, as a share of the period."""
FRAME_S = 0.016
"""turtlesim tells the pose once a frame."""


def why_often(evidence: Evidence, call: str, mean_s: float, period_s: float) -> Cause | None:
    """A loop without a pause around `call`, or a method with it that each message calls."""
    for module in evidence.code.modules:
        for node in module.nodes:
            where = Where(module.file, getattr(node, "lineno", None))
            busy = isinstance(node, ast.While) and _calls(node, call) and not _calls(node, "sleep", "spin_once")
            if busy and mean_s < OFTEN * period_s:
                return Cause("loop-without-pause", f"This loop calls {call} as fast as the machine can.", where)
    if abs(mean_s - FRAME_S) > 0.1 * FRAME_S:
        return None
    for module, name in _callbacks(evidence):
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef) and node.name == name and _calls(node, call):
                text = f"{name} is called by each message, 62.5 times a second, and calls {call} each time."
                return Cause("every-message", text, Where(module.file, node.lineno))
    return None


def why_timers_grow(evidence: Evidence) -> Cause | None:
    """A timer that is made inside of a method that a timer or a message calls."""
    for module in evidence.code.modules:
        called = {name for each, name in _callbacks(evidence, "create_timer", "create_subscription") if each is module}
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef) and node.name in called:
                for inner in ast.walk(node):
                    if isinstance(inner, ast.Call) and getattr(inner.func, "attr", "") == "create_timer":
                        text = f"{node.name} makes one more timer whenever it is called; one goes on by itself."
                        return Cause("timer-in-callback", text, Where(module.file, inner.lineno))
    return None


def _callbacks(evidence: Evidence, *makers: str) -> Iterator[tuple[Module, str]]:
    for maker in makers or ("create_subscription",):
        for call in evidence.code.calls(maker):
            name = dotted(call.argument(1 if maker == "create_timer" else 2, "callback") or ast.Constant(0))
            if name is not None:
                yield call.module, name.rpartition(".")[2]


def _calls(node: ast.AST, *names: str) -> bool:
    calls = (each for each in ast.walk(node) if isinstance(each, ast.Call))
    return any(getattr(call.func, "attr", getattr(call.func, "id", "")) in names for call in calls)

"""Explain why a timer never calls its callback, if the source code shows the reason."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_rate import may_send
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.constants import number, written
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.checks.edit import Edit
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call


def timer_fault(evidence: Evidence, sends: Sequence[str] = ()) -> Cause | None:
    """Return the cause for the first timer whose period is too long or whose callback is wrong, or None.

    If the code calls one of the functions `sends`, a long period counts only for a callback that may call them.
    """
    known = any(evidence.code.calls(name) for name in sends)
    for timer in evidence.code.calls("create_timer"):
        period = number(timer.argument(0, "timer_period_sec"), timer.module.names)
        late = period is not None and period >= evidence.recording.duration_s
        if period is not None and late and (not known or may_send(timer, *sends)):
            text = f"The timer waits {period:g} s before its first call. The period is in seconds, not milliseconds."
            return Cause("timer-milliseconds", text, timer.where).fixed_by(_in_seconds(timer, period))
        if _is_call(timer.argument(1, "callback")) and not _makes_callback(timer):
            text = (
                "create_timer needs the method itself. "
                "With () after the name of the method, create_timer gets only the method's return value."
            )
            called = timer.argument(1, "callback")
            assert isinstance(called, ast.Call)
            name = ast.unparse(called.func)
            fix = at(Where(timer.module.file, called.lineno), f"{name}()", name)
            return Cause("callback-called", text, timer.where).fixed_by(fix)
        named = _named_by_lambda(timer.argument(1, "callback"))
        if named is not None:
            place, name = Where(timer.module.file, named.lineno), ast.unparse(named)
            text = f"The lambda mentions {shorten(name)} but does not call it: the parentheses are missing."
            return Cause("not-called", text, place).fixed_by(at(place, f"lambda: {name}", f"lambda: {name}()"))
    return None


def _in_seconds(timer: Call, period: float) -> tuple[Edit, ...]:
    node = written(timer.argument(0, "timer_period_sec"), timer.module.names)
    return at(Where(timer.module.file, node.lineno), ast.unparse(node), f"{period / 1000.0:g}") if node else ()


def _named_by_lambda(argument: ast.expr | None) -> ast.expr | None:
    """Return the name or attribute that is the whole body of a lambda, or None."""
    body = argument.body if isinstance(argument, ast.Lambda) else None
    return body if isinstance(body, ast.Name | ast.Attribute) else None


def _makes_callback(timer: Call) -> bool:
    """Return whether the callback argument is a call to a class, or to a function that returns a function."""
    called = timer.argument(1, "callback")
    assert isinstance(called, ast.Call)
    name = ast.unparse(called.func).rpartition(".")[2]
    functions = {node.name for node in timer.module.nodes if isinstance(node, ast.FunctionDef)}
    makers = [node for node in timer.module.nodes if isinstance(node, ast.FunctionDef) and node.name == name]
    returned = [each.value for maker in makers for each in ast.walk(maker) if isinstance(each, ast.Return)]
    return any(isinstance(node, ast.ClassDef) and node.name == name for node in timer.module.nodes) or any(
        isinstance(value, ast.Lambda)
        or (isinstance(value, ast.Name | ast.Attribute) and ast.unparse(value).rpartition(".")[2] in functions)
        or (isinstance(value, ast.Call) and ast.unparse(value.func).endswith("partial"))
        for value in returned
    )


def _is_call(argument: ast.expr | None) -> bool:
    return isinstance(argument, ast.Call) and not ast.unparse(argument.func).endswith(("partial", "callback"))

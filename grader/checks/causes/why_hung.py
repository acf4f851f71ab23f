"""Explain why a student's tests do not end, or wait for a person."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.weak_tests import last_name
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.pytest_files import TestCode

LOOP = (
    "If a loop in a test waits for a message, give the loop a deadline. Do not call rclpy.spin in a test, because it "
    "does not return. Call spin_once with a timeout."
)
SPIN = "{name} does not return, so the test does not go on. Call spin_once with a timeout."
WAITS = "Without timeout_sec, spin_once waits until a callback is ready. Write timeout_sec=0."
FOREVER = "This loop has no end. If it waits for a message, give it a deadline."
PERSON = "A test runs without a person, so nobody types an answer. Remove this call."
ASKS = re.compile(r"reading from stdin while output is captured|\bBdbQuit\b|EOFError: EOF when reading a line")
"""Matches the messages about a test that waits for somebody to type something."""
DEBUGGERS = frozenset({"input", "breakpoint", "set_trace"})


def why_hung(code: TestCode, where: Where | None) -> Cause:
    """Return the cause if the tests did not end in time. `where` is the line that failed, if it is known."""
    for node, place in _nodes(code):
        if isinstance(node, ast.Call):
            text = _waits(node, code)
            if text is not None:
                return Cause("test-hangs", text, place)
        if (
            isinstance(node, ast.While)
            and isinstance(node.test, ast.Constant)
            and node.test.value
            and _is_endless(node)
        ):
            return Cause("test-hangs", FOREVER, place)
    return Cause("test-hangs", LOOP, where or (code.tests[0].where if code.tests else None))


def waits_for_a_person(message: str, code: TestCode) -> Cause | None:
    """Return the cause if pytest's message is about a test that reads from the keyboard, else None."""
    if not ASKS.search(message):
        return None
    places = (place for node, place in _nodes(code) if isinstance(node, ast.Call) and last_name(node.func) in DEBUGGERS)
    return Cause("needs-the-outside", PERSON, next(places, None))


def _waits(call: ast.Call, code: TestCode) -> str | None:
    """Return a sentence about a call that may wait forever, or None."""
    name = dotted(call.func) or ""
    last = name.rpartition(".")[2]
    own = {node.name for node, _ in _nodes(code) if isinstance(node, ast.FunctionDef)}
    if last == "spin" and (name == "rclpy.spin" or name.endswith("executor.spin") or "spin" not in own):
        return SPIN.format(name=name)
    given = call.args[1:] if name == "rclpy.spin_once" else call.args
    named = any(each.arg in ("timeout_sec", None) for each in call.keywords)
    return WAITS if last == "spin_once" and not given and not named and last not in own else None


def _is_endless(loop: ast.While) -> bool:
    return not any(isinstance(each, ast.Break | ast.Return | ast.Raise | ast.Assert) for each in ast.walk(loop))


def _nodes(code: TestCode) -> Iterator[tuple[ast.AST, Where]]:
    for module in code.modules:
        yield from ((node, Where(module.file, getattr(node, "lineno", None))) for node in module.nodes)

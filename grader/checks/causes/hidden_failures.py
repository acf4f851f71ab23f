"""Find tests whose failures pytest does not report: the code hides them, or pytest skips or expects them."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.handlers import EVERY_ERROR, caught, suppressed
from grader.checks.causes.weak_tests import asserts, below, last_name
from grader.common.words import count, shorten
from grader.submission.pytest_files import Function
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode
    from grader.testbench.result import NodeRun

CATCHES_ASSERTS = EVERY_ERROR | {"AssertionError"}
"""The exceptions with which an except clause catches the failure of an assert."""
SETS_ASIDE = frozenset({"skip", "skipif", "skipIf", "skipUnless", "xfail", "expectedFailure", "importorskip"})
"""The marks, decorators and functions of pytest and unittest with which a failing test is not counted as failed."""
Tried = (ast.Try, ast.With)


def swallowed(code: TestCode) -> Cause | None:
    """Return the cause if a statement around an assert catches its AssertionError, so that the test passes, else None.

    The assert may be in a function that the statement calls.
    """
    names = {node.name for node in _functions(code) if any(isinstance(each, ast.Assert) for each in ast.walk(node))}
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, Tried) and any(_can_fail(each, names) for each in below(node.body)):
                found = _in_try(module, node) if isinstance(node, ast.Try) else _in_with(module, node)
                if found is not None:
                    return found
    return None


def left_out(run: NodeRun, code: TestCode) -> Cause | None:
    """Return the cause if pytest skipped tests in this run, expected them to fail, or did not run them, else None."""
    where = next(_set_aside(code), None)
    empty = next(_runs_zero_times(code), None)
    if run.skipped and where is None and empty is not None:
        return Cause("test-left-out", "parametrize has no values here, so pytest skips the test.", empty)
    if run.skipped:
        text = f"pytest ignores the failure of {count(run.skipped, 'test')}, because of a mark such as skip or xfail."
        return Cause("test-left-out", text, where)
    if run.test:
        text = "A test failed on this node, but pytest ended with exit code 0. Does conftest.py change the result?"
        return Cause("test-left-out", text)
    if 0 < run.collected < len(code.tests):
        text = (
            f"pytest runs only {run.collected} of the {len(code.tests)} tests in the files. Options in setup.cfg or "
            "pytest.ini, and functions in conftest.py, can exclude tests."
        )
        return Cause("test-left-out", text)
    return None


def _in_try(module: Module, tried: ast.Try) -> Cause | None:
    handler = next((each for each in tried.handlers if caught(each) & CATCHES_ASSERTS), None)
    judged = handler is not None and any(map(asserts, (handler, *tried.orelse)))
    if handler is not None and not judged and not _asserted_later(module, tried, handler):
        text = "This except clause catches the AssertionError, so pytest does not notice the failure."
        return Cause("swallows-failure", text, Where(module.file, handler.lineno))
    ends = next((each for each in tried.finalbody if isinstance(each, ast.Return | ast.Break | ast.Continue)), None)
    if ends is not None:
        word = type(ends).__name__.lower()
        text = f"{word} in a finally block discards the AssertionError, so pytest does not notice the failure."
        return Cause("swallows-failure", text, Where(module.file, ends.lineno))
    return None


def _in_with(module: Module, node: ast.With) -> Cause | None:
    for item in node.items:
        call = item.context_expr
        if isinstance(call, ast.Call) and suppressed(call) & CATCHES_ASSERTS:
            text = f"{shorten(ast.unparse(call.func), 40)} catches the AssertionError, so pytest does not notice it."
            return Cause("swallows-failure", text, Where(module.file, node.lineno))
    return None


def _can_fail(node: ast.AST, names: set[str]) -> bool:
    """Return whether this syntax node is an assert, or a call of a function that asserts something."""
    return isinstance(node, ast.Assert) or (isinstance(node, ast.Call) and last_name(node.func) in names)


def _functions(code: TestCode) -> Iterator[Function]:
    return (node for module in code.modules for node in module.nodes if isinstance(node, Function))


def _set_aside(code: TestCode) -> Iterator[Where]:
    """Yield the lines with names from SETS_ASIDE."""
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Attribute | ast.Name) and last_name(node) in SETS_ASIDE:
                yield Where(module.file, node.lineno)


def _runs_zero_times(code: TestCode) -> Iterator[Where]:
    """Yield the lines with decorators that parametrize a test with an empty list."""
    for test in code.tests:
        for call in (each for each in test.node.decorator_list if isinstance(each, ast.Call)):
            values = call.args[1] if len(call.args) > 1 else None
            if last_name(call.func) == "parametrize" and isinstance(values, ast.List | ast.Tuple) and not values.elts:
                yield Where(test.module.file, call.lineno)


def _asserted_later(module: Module, tried: ast.Try, handler: ast.ExceptHandler) -> bool:
    """Return whether code outside the try statement makes the test fail.

    It may be an assert that uses a name to which the try statement assigns, or to which the except clause appends, or
    the else block of a loop that repeats the try statement.
    """
    loops = [node for node in module.nodes if isinstance(node, ast.For | ast.While) and tried in ast.walk(node)]
    if any(asserts(each) for loop in loops for each in loop.orelse):
        return True
    parts = [handler, *tried.body, *tried.orelse]
    stored = (each for part in parts for each in ast.walk(part) if isinstance(getattr(each, "ctx", None), ast.Store))
    kept = {last_name(each) for each in stored if isinstance(each, ast.Name | ast.Attribute)}
    calls = (each.func for each in ast.walk(handler) if isinstance(each, ast.Call))
    kept |= {
        last_name(each.value) for each in calls if isinstance(each, ast.Attribute) and each.attr in ("append", "add")
    }
    inside = set(map(id, ast.walk(tried)))
    later = [node for node in module.nodes if isinstance(node, ast.Assert) and id(node) not in inside]
    return any(isinstance(each, ast.expr) and last_name(each) in kept for node in later for each in ast.walk(node))

"""Find tests that prove nothing, for example because an assert is missing, and loops that run for a fixed time."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode, TestFunction

CLOCKS = frozenset({"time", "monotonic", "perf_counter", "monotonic_ns", "time_ns", "perf_counter_ns"})
"""Functions of Python's module `time` that measure wall time."""
COMPARING = frozenset({"isclose", "allclose", "approx", "array_equal", "isinstance"})
"""Functions whose result is useless unless something asserts it."""
RAISING = frozenset({"raises", "fail", "warns"})
"""Functions of pytest that can make a test fail."""


def without_assert(code: TestCode) -> tuple[TestFunction, ...]:
    """Return the tests that neither assert anything themselves nor use a function or a fixture that does.

    The assert of a constant, such as `assert True`, does not count.
    """
    functions = _functions(code.modules)
    asserting = {name for name, node in functions if asserts(node)}
    before = -1
    while len(asserting) != before:
        before = len(asserting)
        asserting |= {name for name, node in functions if asserting & _mentioned(node)}
    return tuple(each for each in code.tests if not asserts(each.node) and not asserting & _mentioned(each.node))


def why_without_assert(test: TestFunction) -> Cause:
    """Return the mistake in a test that asserts nothing, such as a comparison without `assert`."""
    for node in _own(test.node):
        if isinstance(node, ast.Assert):
            text = (
                f"{shorten(ast.unparse(node), 40)} never fails. Compare a message with a value that the node promises."
            )
            return Cause("assert-vacuous", text, Where(test.module.file, node.lineno))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Compare):
            text = "Without assert before it, a comparison has no effect."
            return Cause("compares-only", text, Where(test.module.file, node.lineno))
        if isinstance(node, ast.Return) and isinstance(node.value, ast.Compare):
            text = "pytest ignores the return value of a test. Write assert instead of return."
            return Cause("compares-only", text, Where(test.module.file, node.lineno))
    return Cause("no-assert", "A test without an assert fails only if something raises an exception.", test.where)


def without_effect(code: TestCode) -> Cause | None:
    """Return the cause if a line of the test files compares values but does nothing with the result, else None."""
    for module in code.modules:
        for node in (each for each in module.nodes if isinstance(each, ast.Expr)):
            value = node.value
            if isinstance(value, ast.Compare) or (isinstance(value, ast.Call) and last_name(value.func) in COMPARING):
                text = "Without assert before it, a comparison has no effect."
                return Cause("compares-only", text, Where(module.file, node.lineno))
    return None


def named_twice(code: TestCode) -> Cause | None:
    """Return the cause if two test functions at the top level of a file have the same name, else None."""
    found: dict[tuple[str, str], TestFunction] = {}
    for test in code.tests:
        key = (test.module.file, test.node.name)
        other = found.setdefault(key, test)
        if other is not test and other.node.col_offset == test.node.col_offset == 0:
            name = shorten(test.node.name, 60)
            text = f"Another test on line {test.node.lineno} is also named {name}, so pytest never runs this one."
            return Cause("test-named-twice", text, other.where)
    return None


def always_true(code: TestCode) -> Cause | None:
    """Return the cause if an assert is always true because its condition is a tuple, else None."""
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Assert) and isinstance(node.test, ast.Tuple) and node.test.elts:
                text = "assert (condition, message) tests a tuple, which is always true. Remove the parentheses."
                return Cause("assert-tuple", text, Where(module.file, node.lineno))
    return None


def always_false(code: TestCode) -> Cause | None:
    """Return the cause if a test fails on every ROS node, because it asserts a false constant or calls pytest.fail.

    Return None if there is no such test.

    A test that may return, or skip itself, before it fails does not count. Neither does a test with a decorator that
    skips it or expects it to fail.
    """
    for test in code.tests:
        if any(word in ast.unparse(each) for each in test.node.decorator_list for word in ("skip", "xfail")):
            continue
        for node in test.node.body:
            if any(isinstance(each, ast.Return) or _is_call_of(each, "skip") for each in ast.walk(node)):
                break
            value = node.test if isinstance(node, ast.Assert) else None
            is_false = isinstance(value, ast.Constant) and not value.value
            if is_false or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call) and _fails(node.value)):
                text = f"{shorten(test.node.name, 60)} fails on every node, even on the correct node."
                return Cause("always-fails", text, Where(test.module.file, node.lineno))
    return None


def in_a_loop(code: TestCode) -> Cause | None:
    """Return the cause if all asserts of a test are in a loop over a list that may be empty, else None."""
    for test in code.tests:
        asserts = [node for node in ast.walk(test.node) if isinstance(node, ast.Assert)]
        others = [
            node for node in ast.walk(test.node) if isinstance(node, ast.Raise | ast.Call) and _asserts_here(node)
        ]
        loops = [node for node in ast.walk(test.node) if isinstance(node, ast.For)]
        for node in loops if asserts else ():
            inside = set(map(id, ast.walk(node)))
            if _may_be_empty(node.iter, test.module) and {id(each) for each in asserts + others} <= inside:
                text = "If there is nothing to loop over, for example no message, the assert in this loop never runs."
                return Cause("assert-in-loop", text, Where(test.module.file, node.lineno))
    return None


def _may_be_empty(listed: ast.expr, module: Module) -> bool:
    """Return whether a loop over this expression may run zero times.

    The result of a call is assumed not to be empty.
    """
    if isinstance(listed, ast.Call | ast.List | ast.Tuple):
        return False
    value = module.names.get(dotted(listed) or "")
    return not (isinstance(value, ast.List | ast.Tuple) and value.elts)


def timed_loop(code: TestCode) -> Cause | None:
    """Return the cause if a loop runs for a fixed wall time, as a call to sleep does, else None.

    A loop that waits for something until a deadline is correct.
    """
    for module in code.modules:
        for node in module.nodes:
            if not isinstance(node, ast.While) or not isinstance(node.test, ast.Compare):
                continue
            parts = [node.test.left, *node.test.comparators]
            wall = any(
                isinstance(each, ast.Call) and last_name(each.func) in CLOCKS
                for part in parts
                for each in ast.walk(part)
            )
            if wall and not any(isinstance(each, ast.Break | ast.Return | ast.Raise) for each in below(node.body)):
                text = (
                    "On a slow computer, the node does less in this time. Advance the node's clock, or end the loop "
                    "when the message has arrived, and use the time only as a deadline."
                )
                return Cause("sleeps-by-luck", text, Where(module.file, node.lineno))
    return None


def _functions(modules: tuple[Module, ...]) -> list[tuple[str, ast.AST]]:
    return [
        (node.name, node)
        for module in modules
        for node in module.nodes
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]


def asserts(node: ast.AST) -> bool:
    """Return whether a function or an except clause can itself make a test fail, with pytest or with unittest."""
    return any(map(_asserts_here, ast.walk(node)))


def _asserts_here(node: ast.AST) -> bool:
    """Return whether this syntax node itself can make a test fail: an assert, a raise, or such a call."""
    if isinstance(node, ast.Assert):
        return not (isinstance(node.test, ast.Constant) and node.test.value)
    name = last_name(node.func) if isinstance(node, ast.Call) else ""
    return isinstance(node, ast.Raise) or name in RAISING or name.startswith("assert")


def _mentioned(node: ast.AST) -> set[str]:
    """Return the names of the functions that a function calls, and of the fixtures that it requests."""
    names = {last_name(each.func) for each in ast.walk(node) if isinstance(each, ast.Call)}
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        names |= {argument.arg for argument in node.args.args}
    return names


def last_name(node: ast.AST) -> str:
    """Return the name, or the last part of a dotted expression, or an empty string for other syntax nodes."""
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def _fails(node: ast.AST) -> bool:
    """Return whether the node is a call to the function fail of pytest or unittest, not of another object."""
    return isinstance(node, ast.Call) and dotted(node.func) in ("pytest.fail", "fail", "self.fail")


def _is_call_of(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Call) and last_name(node.value.func) == name


def _own(function: ast.AST) -> Iterator[ast.AST]:
    """Yield the syntax nodes of a function, except the nodes of functions and classes that are defined inside it."""
    for node in ast.iter_child_nodes(function):
        yield node
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            yield from _own(node)


def below(body: list[ast.stmt]) -> Iterator[ast.AST]:
    """Yield all syntax nodes of these statements."""
    for statement in body:
        yield from ast.walk(statement)

"""Explain an exception that a student's test raises on the correct node."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import MEANINGS
from grader.checks.causes.weak_tests import last_name
from grader.common.words import shorten
from grader.submission.pytest_files import is_case, is_fixture
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode

RAISED = re.compile(r"(?:E\s+)?(?:\w+\.)*(?P<error>\w+(?:Error|Exception)): ")
MISSING = re.compile(r"(?P<owner>\w+)\.(?P<method>\w+)\(\) missing \d+ required positional argument")
NO_ATTRIBUTE = re.compile(r"'(?P<owner>\w+)' object has no attribute")
OF_EXPECTATIONS = frozenset({"AssertionError", "IndexError"})
"""The exceptions that may show a wrong expectation. All others show a mistake in the code of the tests."""


def why_test_raised(message: str, code: TestCode, where: Where | None) -> Cause | None:
    """Return the cause if pytest's message is about an exception that no assert raises, else None."""
    raised = RAISED.match(message)
    if raised is None or raised["error"] in OF_EXPECTATIONS or _raises(code, raised["error"]):
        return None
    text = "The code of the test raises this exception itself, so no assert has failed."
    if raised["error"] in MEANINGS:
        text = f"{text} {MEANINGS[raised['error']]}"
    known = _class_for_object(message, code) or _fixture_in_case(message, code) or _without_self(message, code)
    known = known or _setup_not_called(message, code) or _fixture_of_nothing(message, code)
    return known or Cause("rejects-right", text, where)


def _raises(code: TestCode, error: str) -> bool:
    """Return whether the tests contain a raise statement with this exception."""
    raised = (node.exc for _, node in _nodes(code) if isinstance(node, ast.Raise))
    return any(last_name(each.func if isinstance(each, ast.Call) else each) == error for each in raised if each)


def _fixture_in_case(message: str, code: TestCode) -> Cause | None:
    """Return the cause if a method of a unittest.TestCase has a fixture as its parameter, else None."""
    missing = MISSING.search(message)
    for module, node in _nodes(code) if missing else ():
        if missing and isinstance(node, ast.ClassDef) and node.name == missing["owner"] and is_case(node):
            text = "pytest gives no fixtures to the methods of a unittest.TestCase. Use its method setUp instead."
            return Cause("fixture-missing", text, Where(module.file, node.lineno))
    return None


def _setup_not_called(message: str, code: TestCode) -> Cause | None:
    """Return the cause if pytest does not call the method of the test class that sets the attributes, else None."""
    owner = NO_ATTRIBUTE.search(message)
    for module, node in _nodes(code) if owner else ():
        if owner is None or not isinstance(node, ast.ClassDef) or node.name != owner["owner"]:
            continue
        uncalled = {"setup", "setup_method"} if is_case(node) else {"setup", "setUp"}
        for method in (each for each in node.body if isinstance(each, ast.FunctionDef)):
            if method.name in uncalled and not is_fixture(method):
                right = "setUp" if is_case(node) else "setup_method"
                text = f"pytest does not call {method.name} in this class. The right name is {right}."
                return Cause("rejects-right", text, Where(module.file, method.lineno))
    return None


def _fixture_of_nothing(message: str, code: TestCode) -> Cause | None:
    """Return the cause if a fixture yields or returns no value, and a test uses its value, else None."""
    if "'NoneType' object" not in message:
        return None
    used = {each.arg for test in code.tests for each in test.node.args.args}
    for module, node in _nodes(code):
        if isinstance(node, ast.FunctionDef) and is_fixture(node) and node.name in used:
            given = [each.value for each in ast.walk(node) if isinstance(each, ast.Yield | ast.Return)]
            if not any(given):
                text = (
                    f"The fixture {shorten(node.name, 40)} yields no value, so the test gets None. Write yield Bench()."
                )
                return Cause("rejects-right", text, Where(module.file, node.lineno))
    return None


def _class_for_object(message: str, code: TestCode) -> Cause | None:
    """Return the cause if the tests return, yield or assign the class whose method lacks an argument, else None."""
    missing = MISSING.search(message)
    if missing is None:
        return None
    for module, node in _nodes(code):
        given = node.value if isinstance(node, ast.Yield | ast.Return | ast.Assign) else None
        if isinstance(given, ast.Name) and given.id == missing["owner"]:
            text = f"{given.id} is the class itself. Write {given.id}() to create an object."
            return Cause("class-for-object", text, Where(module.file, node.lineno))
    return None


def _without_self(message: str, code: TestCode) -> Cause | None:
    """Return the cause if the first parameter of a method of the test class is not self, else None."""
    owner = NO_ATTRIBUTE.search(message)
    if owner is None:
        return None
    for module, node in _nodes(code):
        for method in node.body if isinstance(node, ast.ClassDef) and node.name == owner["owner"] else ():
            first = method.args.args[:1] if isinstance(method, ast.FunctionDef) else []
            if first and first[0].arg != "self" and isinstance(method, ast.FunctionDef) and not _is_static(method):
                name = shorten(method.name, 60)
                text = f"{name} is a method, so its first parameter is self. Write (self, {shorten(first[0].arg)})."
                return Cause("self-parameter", text, Where(module.file, method.lineno))
    return None


def _is_static(method: ast.FunctionDef) -> bool:
    """Return whether the method is a class method or a static method, so that its first parameter is not self."""
    return any(ast.unparse(each) in ("classmethod", "staticmethod") for each in method.decorator_list)


def _nodes(code: TestCode) -> Iterator[tuple[Module, ast.expr | ast.stmt]]:
    for module in code.modules:
        yield from ((module, node) for node in module.nodes if isinstance(node, ast.expr | ast.stmt))

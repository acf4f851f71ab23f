"""Explain an exception, other than AssertionError, that a student's test raises on the correct node."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import MEANINGS
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode

RAISED = re.compile(r"(?:E\s+)?(?:\w+\.)*(?P<error>\w+Error): ")
MISSING = re.compile(r"(?P<owner>\w+)\.(?P<method>\w+)\(\) missing \d+ required positional argument")
NO_ATTRIBUTE = re.compile(r"'(?P<owner>\w+)' object has no attribute")
IN_TESTS = frozenset({"AttributeError", "KeyError", "NameError", "TypeError", "ValueError", "ZeroDivisionError"})
"""The exceptions that show a mistake in the code of the tests rather than a wrong expectation."""


def why_test_raised(message: str, code: TestCode, where: Where | None) -> Cause | None:
    """Return the cause if pytest's message is about an exception in IN_TESTS, else None."""
    raised = RAISED.match(message)
    if raised is None or raised["error"] not in IN_TESTS:
        return None
    text = f"The code of the test raises this exception itself, so no assert has failed. {MEANINGS[raised['error']]}"
    return _class_for_object(message, code) or _without_self(message, code) or Cause("rejects-right", text, where)


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

"""Explain why pytest finds no test in a package."""

from __future__ import annotations

import ast

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.pytest_files import Function, TestCode, has_init, is_fixture
from grader.submission.where import Where


def why_no_test(code: TestCode) -> Cause:
    """Return the reason why pytest finds no test in these files."""
    if not code.files:
        for module in code.modules:
            if any(isinstance(node, ast.Assert) for node in module.nodes):
                name = module.file.rpartition("/")[2]
                text = f"pytest collects tests from files named test_SOMETHING.py. It ignores {shorten(name, 60)}."
                return Cause("test-file-name", text, Where(module.file))
        return Cause("no-test-file", "The tests belong in a file test/test_SOMETHING.py.", Where("test"))
    for module in code.files:
        for node in module.body:
            if isinstance(node, ast.ClassDef) and node.name.startswith("Test") and has_init(node):
                text = "pytest ignores a test class that has an __init__. Use a fixture, or setup_method."
                return Cause("test-class-init", text, Where(module.file, node.lineno))
            if isinstance(node, ast.ClassDef) and not node.name.startswith("Test") and _has_test(node):
                text = f"pytest ignores the class {shorten(node.name, 60)}, because its name does not begin with Test."
                return Cause("test-function-name", text, Where(module.file, node.lineno))
        misnamed = _misnamed(module.nodes)
        if misnamed is not None:
            text = f"pytest ignores {shorten(misnamed.name, 60)}, because its name does not begin with test."
            return Cause("test-function-name", text, Where(module.file, misnamed.lineno))
    return Cause("no-test-function", "A test is a function whose name begins with test.", Where(code.files[0].file))


def _has_test(node: ast.ClassDef) -> bool:
    return any(isinstance(each, Function) and each.name.startswith("test") for each in node.body)


def _misnamed(nodes: tuple[ast.AST, ...]) -> Function | None:
    """Return a function that has an assert but is neither called nor named like a test, or None."""
    called = {node.id for node in nodes if isinstance(node, ast.Name)}
    called |= {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    for node in nodes:
        if not isinstance(node, Function) or node.name in called or is_fixture(node):
            continue
        if not node.name.startswith(("test", "_")) and any(isinstance(each, ast.Assert) for each in ast.walk(node)):
            return node
    return None

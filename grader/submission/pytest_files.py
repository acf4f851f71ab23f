"""The test files of a submission as pytest finds them, read with `ast` and never run."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from fnmatch import fnmatch
from typing import TYPE_CHECKING

from grader.errors import TooLargeError
from grader.submission.code import MOST_BYTES, Module, read_module
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

PATTERNS = ("test_*.py", "*_test.py")
"""The names of files in which pytest looks for tests."""
NO_TESTS = ("setup.py",)
Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class TestFunction:
    """A function or method that pytest runs as a test, and the file that contains it."""

    __test__ = False  # keeps pytest from collecting this class

    node: Function
    module: Module

    @property
    def where(self) -> Where:
        """The file and line of the function's `def`."""
        return Where(self.module.file, self.node.lineno)


@dataclass(frozen=True)
class TestCode:
    """The test files of a package, and all other Python files outside its module folder, except setup.py."""

    __test__ = False

    modules: tuple[Module, ...]

    @property
    def files(self) -> tuple[Module, ...]:
        """The files in which pytest looks for tests."""
        return tuple(module for module in self.modules if is_test_file(module.file))

    @property
    def tests(self) -> tuple[TestFunction, ...]:
        """The functions that pytest runs as tests, in the order of the files."""
        return tuple(TestFunction(node, module) for module in self.files for node in _tests(module.body))


def is_test_file(path: str) -> bool:
    """Return whether pytest looks for tests in a file of this name."""
    return any(fnmatch(path.rpartition("/")[2], pattern) for pattern in PATTERNS)


def read_test_code(files: Mapping[str, bytes], folder: str) -> TestCode:
    """Read the test files and their helpers. `folder` is the package's module folder.

    Raises TooLargeError if the files are larger than anyone would write by hand.
    """
    inside = f"{folder}/"
    paths = [
        path
        for path in sorted(files)
        if path.endswith(".py") and path not in NO_TESTS and (is_test_file(path) or not path.startswith(inside))
    ]
    if sum(len(files[path]) for path in paths) > MOST_BYTES:
        message = f"the test files have more than {MOST_BYTES // 1000} kB"
        raise TooLargeError(message)
    return TestCode(tuple(read_module(path, files[path]) for path in paths))


def is_fixture(node: ast.AST) -> bool:
    """Return whether a function is a pytest fixture."""
    decorators = getattr(node, "decorator_list", [])
    targets = [each.func if isinstance(each, ast.Call) else each for each in decorators]
    return any((dotted(each) or "").rpartition(".")[2] == "fixture" for each in targets)


def is_case(node: ast.ClassDef) -> bool:
    """Return whether the class derives from unittest.TestCase."""
    return any((dotted(base) or "").rpartition(".")[2] == "TestCase" for base in node.bases)


def has_init(node: ast.ClassDef) -> bool:
    """Return whether the class defines its own __init__."""
    return any(isinstance(each, ast.FunctionDef) and each.name == "__init__" for each in node.body)


def _tests(body: list[ast.stmt], *, methods: bool = False) -> Iterator[Function]:
    for node in body:
        if isinstance(node, Function) and node.name.startswith("test") and not is_fixture(node):
            yield node
        elif isinstance(node, ast.ClassDef) and not methods and _is_class_of_tests(node):
            yield from _tests(node.body, methods=True)


def _is_class_of_tests(node: ast.ClassDef) -> bool:
    return is_case(node) or (node.name.startswith("Test") and not has_init(node))

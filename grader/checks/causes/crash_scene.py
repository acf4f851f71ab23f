"""The student's source code around the line that raised an exception."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.submission.code import read_module
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash import Crash
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

Function = ast.FunctionDef | ast.AsyncFunctionDef
MANGLED = re.compile(r"^_(?P<of>[A-Za-z]\w*?)__(?=[a-zA-Z])")
"""The prefix that Python adds to a name that begins with two underscores and is used in a class."""


@dataclass(frozen=True)
class CrashScene:
    """An exception in the student's code. If its line is unknown, the properties are None, 0 or empty."""

    evidence: Evidence
    crash: Crash

    @cached_property
    def module(self) -> Module | None:
        """The module that contains the line, or None."""
        return None if self.crash.where is None else self.module_of(self.crash.where.file)

    def module_of(self, file: str) -> Module | None:
        """Return the module in this file of the submission, or None if there is no such file."""
        files = self.evidence.submission.files
        known = (each for each in self.evidence.code.modules if each.file == file)
        return next(known, None) or (read_module(file, files[file]) if file in files else None)

    @property
    def line(self) -> int:
        """The line number of the exception, or 0 if the line is unknown."""
        where = self.crash.where
        return (where.line if where is not None else None) or 0

    @cached_property
    def nodes(self) -> tuple[ast.AST, ...]:
        """Every node of the module's syntax tree."""
        return self.module.nodes if self.module is not None else ()

    @cached_property
    def on_line(self) -> tuple[ast.AST, ...]:
        """The syntax nodes on the line, except classes, functions, and if, for, while, try and with statements."""
        return tuple(
            node for node in self.nodes if getattr(node, "lineno", 0) <= self.line <= _end(node) and _small(node)
        )

    def calls_on_line(self, name: str) -> list[ast.Call]:
        """Return the calls on the line whose function or method has this name, such as "spin" for rclpy.spin(node)."""
        calls = [node for node in self.on_line if isinstance(node, ast.Call)]
        return [call for call in calls if _last(call.func) == name]

    @cached_property
    def classes(self) -> tuple[ast.ClassDef, ...]:
        """Every class of the module."""
        return tuple(node for node in self.nodes if isinstance(node, ast.ClassDef))

    def class_named(self, name: str) -> ast.ClassDef | None:
        """Return the module's class with this name, or None."""
        return next((each for each in self.classes if each.name == name), None)

    @cached_property
    def own_class(self) -> ast.ClassDef | None:
        """The class that contains the line, or None."""
        inside = [each for each in self.classes if each.lineno <= self.line <= _end(each)]
        return inside[-1] if inside else None

    def written(self, name: str) -> str:
        """Return a name in a message as it is in the source. Python adds a prefix to a name such as __speed."""
        mangled = MANGLED.match(name)
        own = mangled is not None and any(each.name.lstrip("_") == mangled["of"] for each in self.classes)
        return MANGLED.sub("__", name) if own else name

    @property
    def function(self) -> Function | None:
        """The innermost function that contains the line, or None."""
        inside = [node for node in self.nodes if isinstance(node, Function) and node.lineno <= self.line <= _end(node)]
        return max(inside, key=lambda node: node.lineno, default=None)

    def function_around(self, node: ast.AST) -> Function | None:
        """Return the innermost function that contains the node, or None."""
        around = [each for each in self.nodes if isinstance(each, Function) and _contains(each, node)]
        return max(around, key=lambda each: each.lineno, default=None)

    def class_around(self, node: ast.AST) -> ast.ClassDef | None:
        """Return the class whose body directly contains the node, or None."""
        return next((each for each in self.classes if node in each.body), None)

    def top_functions(self) -> list[Function]:
        """Return the functions at the top level of the module."""
        return [node for node in (self.module.body if self.module is not None else []) if isinstance(node, Function)]

    def functions(self, name: str) -> list[Function]:
        """Return every function or method with this name."""
        return [node for node in self.nodes if isinstance(node, Function) and node.name == name]

    def at(self, node: ast.AST | int | None) -> Where | None:
        """Return the place of a syntax node or line number, or of the exception if no node or module is known."""
        if node is None or self.module is None:
            return self.crash.where
        return Where(self.module.file, node if isinstance(node, int) else getattr(node, "lineno", None))


def methods(of: ast.ClassDef) -> list[Function]:
    """Return the methods of a class."""
    return [node for node in of.body if isinstance(node, Function)]


def attributes_set(of: ast.ClassDef) -> Iterator[tuple[str, int]]:
    """Yield the name and the line of each assignment to an attribute of self.

    Assignments such as += do not count. Neither do annotations without a value, such as `self.speed: float`.
    """
    others = {
        id(node.target)
        for node in ast.walk(of)
        if isinstance(node, ast.AugAssign) or (isinstance(node, ast.AnnAssign) and node.value is None)
    }
    for node in ast.walk(of):
        if id(node) in others:
            continue
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and dotted(node) == f"self.{node.attr}":
            yield node.attr, node.lineno


def _contains(outer: ast.AST, node: ast.AST) -> bool:
    line = getattr(node, "lineno", 0)
    return outer is not node and getattr(outer, "lineno", 0) <= line <= _end(outer)


def _end(node: ast.AST) -> int:
    return getattr(node, "end_lineno", None) or 0


def _small(node: ast.AST) -> bool:
    """Return whether the syntax node is neither a class or function nor an if, for, while, try or with statement."""
    return not isinstance(
        node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef | ast.If | ast.For | ast.While | ast.Try | ast.With
    )


def _last(function: ast.expr) -> str:
    return (dotted(function) or "").rpartition(".")[2] or getattr(function, "attr", "")

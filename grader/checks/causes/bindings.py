"""The lines of a student's file that bind a name: assignments, definitions, imports, and names in other statements."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.causes.crash_scene import Function

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene

COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


@dataclass(frozen=True)
class Binding:
    """A place that gives a name a value.

    `node` is the node of the syntax tree that contains the name. `function` is the innermost function around the node.
    If a class is around the node and no function is nearer, `of_class` is this class. `in_brackets` is true for a
    variable of a comprehension, which exists only inside it. `of_loop` is true for a variable of a for statement.
    """

    name: str
    node: ast.AST
    function: Function | None = None
    of_class: ast.ClassDef | None = None
    in_brackets: bool = False
    of_loop: bool = False

    @property
    def line(self) -> int:
        """The line of the node."""
        return getattr(self.node, "lineno", 0)

    @property
    def is_definition(self) -> bool:
        """Whether the node defines a function or a class."""
        return isinstance(self.node, Function | ast.ClassDef)

    @property
    def is_import(self) -> bool:
        """Whether the node is an import."""
        return isinstance(self.node, ast.Import | ast.ImportFrom)

    @property
    def by_global(self) -> bool:
        """Whether the function declares the name with a global statement."""
        return self.function is not None and is_global(self.function, self.name)


def bindings(scene: CrashScene, name: str) -> list[Binding]:
    """Return every place of the file that gives this name a value, in the order of the lines."""
    brackets = {
        id(each)
        for node in scene.nodes
        if isinstance(node, COMPREHENSIONS)
        for generator in node.generators
        for each in ast.walk(generator.target)
    }
    loops = {
        id(each) for node in scene.nodes if isinstance(node, ast.For | ast.AsyncFor) for each in ast.walk(node.target)
    }
    found = []
    for node in scene.nodes:
        if name in names_bound(node):
            function = scene.function_around(node)
            of_class, at = _class_of(scene, node, function), id(node)
            found.append(Binding(name, node, function, of_class, at in brackets, at in loops))
    return sorted(found, key=lambda each: each.line)


def names_bound(node: ast.AST) -> Iterator[str]:
    """Yield the names that this node of the syntax tree binds, without the names that its children bind.

    Parameters do not count.
    """
    match node:
        case ast.Name(id=name, ctx=ast.Store()):
            yield name
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            yield from (each.asname or each.name.partition(".")[0] for each in names if each.name != "*")
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
            yield name
        case ast.MatchMapping(rest=str(name)):
            yield name
        case _:
            return


def is_global(function: Function, name: str) -> bool:
    """Return whether the function declares the name with a global statement."""
    return any(isinstance(node, ast.Global) and name in node.names for node in ast.walk(function))


def _class_of(scene: CrashScene, node: ast.AST, function: Function | None) -> ast.ClassDef | None:
    """Return the innermost class around the node, or None if a function is nearer."""
    line = getattr(node, "lineno", 0)
    around = [each for each in scene.classes if each is not node and each.lineno <= line <= (each.end_lineno or 0)]
    nearest = max(around, key=lambda each: each.lineno, default=None)
    inside = nearest is not None and (function is None or function.lineno < nearest.lineno)
    return nearest if inside else None

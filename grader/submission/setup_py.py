"""SetupPy: the arguments that a setup.py passes to setuptools, read with `ast` and never run."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from grader.errors import TooLargeError
from grader.submission.code import Call, Module, Unreadable, read_module
from grader.submission.constants import MAX_DEPTH, dotted, evaluate
from grader.submission.extras import extras_of_setup

if TYPE_CHECKING:
    from collections.abc import Iterator

TARGET = re.compile(r"(?P<module>[\w.]+)\s*:\s*(?P<attribute>[\w.]+)\s*(\[.*\])?")
"""The part of an entry point after the "=", which is module:attribute."""
MAX_ENTRY_POINT = 300
MOST_ENTRY_POINTS = 1000


@dataclass(frozen=True)
class EntryPoint:
    """An entry point as a string. `target` is "module:attribute", or None if the string has another form."""

    text: str
    line: int
    name: str
    target: str | None


@dataclass(frozen=True)
class SetupPy:
    """The arguments of setup() that are constants. All other arguments are None or empty."""

    name: str | None = None
    name_line: int | None = None
    entry_points: tuple[EntryPoint, ...] | None = None
    data_files: tuple[tuple[str, tuple[str, ...]], ...] | None = None
    finds_packages: bool = False
    """Whether setup() has the argument packages=find_packages(...)."""
    packages_line: int | None = None
    """The line of the argument `packages`."""
    setup_line: int | None = None
    groups: tuple[str, ...] = ()
    """The names of the groups in entry_points."""
    required: tuple[str, ...] = ()
    """The value of install_requires."""
    tested_with: tuple[str, ...] | None = ()
    """The packages for tests in extras_require, which determine how colcon runs the tests. None if they are unknown."""
    has_extras: bool = False
    """Whether setup() has the argument extras_require. Without it, setuptools reads setup.cfg and pyproject.toml."""
    tests_require_line: int | None = None
    """The line of the argument tests_require, which setuptools has ignored since version 72."""
    stray: tuple[EntryPoint, ...] = ()
    """Strings outside console_scripts that look like entry points."""
    unreadable: Unreadable | None = None

    def entry_point(self, name: str) -> EntryPoint | None:
        """Return the console script with this name, or None."""
        return next((point for point in self.entry_points or () if point.name == name), None)


def read_setup_py(data: bytes) -> SetupPy:
    """Read a setup.py.

    Arguments that are not constant remain unknown. A mistake in the file raises no exception.

    Raises TooLargeError if the file is too large or nested too deeply, or lists too many executables.
    """
    module = read_module("setup.py", data)
    if module.tree is None:
        return SetupPy(unreadable=module.unreadable)
    calls = [node for node in module.nodes if isinstance(node, ast.Call) and _last(node.func) == "setup"]
    if not calls:
        return SetupPy()
    call = Call(calls[0], module)
    name = call.argument(0, "name")
    value = evaluate(name, module.names)
    packages = call.argument(99, "packages")
    groups = _groups(call, module)
    points = _entry_points(groups, module)
    return SetupPy(
        name=value if isinstance(value, str) else None,
        name_line=_value_line(name, module),
        entry_points=points,
        data_files=_data_files(call, module),
        finds_packages=isinstance(packages, ast.Call) and _last(packages.func) == "find_packages",
        packages_line=None if packages is None else packages.lineno,
        setup_line=call.node.lineno,
        groups=tuple(groups or ()),
        required=tuple(_strings(call.argument(99, "install_requires"), module)),
        tests_require_line=_value_line(call.argument(99, "tests_require"), module),
        tested_with=_tested_with(call, module),
        has_extras=call.argument(99, "extras_require") is not None,
        stray=_stray(module, points or ()),
    )


def _stray(module: Module, points: tuple[EntryPoint, ...]) -> tuple[EntryPoint, ...]:
    known = {point.text for point in points}
    texts = [
        (node.value, node.lineno)
        for node in module.nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    points_ = (_entry_point(text, line) for text, line in texts if text not in known)
    return tuple(islice((point for point in points_ if point.target is not None), MOST_ENTRY_POINTS))


def _entry_point(text: str, line: int) -> EntryPoint:
    """Read `name = module:attribute` as setuptools does, but in linear time for any string."""
    kept = text[:MAX_ENTRY_POINT]
    name, _, rest = kept.partition("=")
    match = TARGET.fullmatch(rest.strip()) if name.strip() else None
    return EntryPoint(kept, line, name.strip(), f"{match['module']}:{match['attribute']}" if match else None)


def _last(node: ast.expr) -> str:
    return (dotted(node) or "").rpartition(".")[2]


def _value_line(node: ast.expr | None, module: Module) -> int | None:
    """Return the line of a value, or None. For a name, this is the line of the value that is assigned to the name."""
    for _ in range(MAX_DEPTH):  # `a = b; b = a` would loop forever
        if not isinstance(node, ast.Name) or module.names.get(node.id) is None:
            break
        node = module.names[node.id]
    return None if node is None else node.lineno


def _resolved(node: ast.expr | None, module: Module) -> ast.expr | None:
    """Return the expression itself or, for a name, the expression that is assigned to it, or None if it is unknown."""
    return module.names.get(node.id) if isinstance(node, ast.Name) else node


def _groups(call: Call, module: Module) -> dict[str, ast.expr] | None:
    """Return the groups in entry_points (empty if there are none), or None if entry_points is not a known dictionary.

    Groups whose names are not constant are left out.
    """
    given = call.argument(99, "entry_points")
    if given is None:
        return None if any(keyword.arg is None for keyword in call.node.keywords) else {}
    table = _resolved(given, module)
    if not isinstance(table, ast.Dict):
        return None
    groups: dict[str, ast.expr] = {}
    for key, value in zip(table.keys, table.values, strict=True):
        name = evaluate(key, module.names)
        if isinstance(name, str):
            groups[name] = value
    return groups


def _entry_points(groups: dict[str, ast.expr] | None, module: Module) -> tuple[EntryPoint, ...] | None:
    if groups is None:
        return None
    listed = _resolved(groups.get("console_scripts"), module)
    if listed is None:
        return ()
    if not isinstance(listed, ast.List | ast.Tuple):
        return None
    points: list[EntryPoint] = []
    for item in listed.elts:
        text = evaluate(item, module.names)
        if not isinstance(text, str):
            return None
        points.append(_entry_point(text, item.lineno))
        if len(points) > MOST_ENTRY_POINTS:
            message = f"setup.py lists more than {MOST_ENTRY_POINTS} executables"
            raise TooLargeError(message)
    return tuple(points)


def _data_files(call: Call, module: Module) -> tuple[tuple[str, tuple[str, ...]], ...] | None:
    listed = _resolved(call.argument(99, "data_files"), module)
    if listed is None:
        return () if call.argument(99, "data_files") is None else None
    if not isinstance(listed, ast.List | ast.Tuple):
        return None
    return tuple(_data_file(item, module) for item in listed.elts)


def _data_file(item: ast.expr, module: Module) -> tuple[str, tuple[str, ...]]:
    """Return one pair (folder, files).

    A folder or a file that is not constant becomes an empty string. Files that are not in a list become an empty tuple.
    An item that is not such a pair becomes ("", ()).
    """
    if not isinstance(item, ast.Tuple | ast.List) or len(item.elts) != 2:
        return "", ()
    folder, files = item.elts
    return _string(folder, module), tuple(_strings(files, module))


def _tested_with(call: Call, module: Module) -> tuple[str, ...] | None:
    given = call.argument(99, "extras_require")
    if given is None:
        return None if any(keyword.arg is None for keyword in call.node.keywords) else ()
    return extras_of_setup(given, module)


def _strings(node: ast.expr | None, module: Module) -> Iterator[str]:
    resolved = _resolved(node, module)
    if isinstance(resolved, ast.List | ast.Tuple):
        for item in resolved.elts:
            yield _string(item, module)


def _string(node: ast.expr, module: Module) -> str:
    value = evaluate(node, module.names)
    return value if isinstance(value, str) else ""

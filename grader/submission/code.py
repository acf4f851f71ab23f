"""Code: the Python files of a submission, read with `ast` and never run."""

from __future__ import annotations

import ast
import warnings
from collections import deque
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.common.words import shorten
from grader.errors import TooLargeError
from grader.submission.constants import Names, dotted, single_names
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

MAX_BYTES = 400_000
"""The maximum size of a file that is parsed (bytes). Nobody writes a larger file by hand."""
MOST_BYTES = 1_000_000
"""The maximum total size of the files of one node (bytes)."""
MAX_NAME = 500
"""The maximum length of a module name (characters)."""

SRC = "src/"
"""The folder that contains the packages in many Python projects, with package_dir={"": "src"} in setup.py."""


@dataclass(frozen=True)
class Unreadable:
    """The reason why Python cannot parse a file.

    `line` counts from 1, and is None if Python's error message contains no line number.
    """

    message: str
    line: int | None = None


@dataclass(frozen=True)
class Module:
    """A Python file with its syntax tree, or with the reason why it cannot be parsed."""

    file: str
    tree: ast.Module | None = None
    unreadable: Unreadable | None = None

    @cached_property
    def names(self) -> Names:
        """The assigned names with their expressions, as `single_names` returns them."""
        return Names() if self.tree is None else single_names(self.tree)

    @property
    def body(self) -> list[ast.stmt]:
        """The statements at the top level."""
        return [] if self.tree is None else self.tree.body

    @cached_property
    def nodes(self) -> tuple[ast.AST, ...]:
        """All nodes of the syntax tree."""
        return () if self.tree is None else tuple(ast.walk(self.tree))


ALIKE = {"create_lifecycle_publisher": "create_publisher"}
"""Maps a method of lifecycle nodes to the method of all nodes that has the same arguments."""


@dataclass(frozen=True)
class Call:
    """A function call, and the module that contains it."""

    node: ast.Call
    module: Module

    @property
    def where(self) -> Where:
        """The line that contains the call."""
        return Where(self.module.file, self.node.lineno)

    def argument(self, place: int, name: str) -> ast.expr | None:
        """Return the argument at this position (from 0) or with this name, or None."""
        for keyword in self.node.keywords:
            if keyword.arg == name:
                return keyword.value
        plain = self.node.args[: place + 1]
        starred = any(isinstance(argument, ast.Starred) for argument in plain)
        return plain[place] if len(plain) > place and not starred else None


@dataclass(frozen=True)
class Code:
    """The node's file and the submission files that it imports, or all Python files if the node's file is unknown.

    Tests, launch files and setup.py are left out.
    """

    modules: tuple[Module, ...]
    node_file: str | None = None

    @property
    def start(self) -> Where | None:
        """The node's file as a place without a line, for messages about the whole file. None if the file is unknown."""
        return None if self.node_file is None else Where(self.node_file)

    @cached_property
    def _calls(self) -> dict[str, list[Call]]:
        found: dict[str, list[Call]] = {}
        for module in self.modules:
            for node in module.nodes:
                if isinstance(node, ast.Call):
                    name = (dotted(node.func) or "").rpartition(".")[2] or getattr(node.func, "attr", "")
                    for each in {name, ALIKE.get(name, name)}:
                        found.setdefault(each, []).append(Call(node, module))
        place = {module.file: index for index, module in enumerate(self.modules)}
        for calls in found.values():
            calls.sort(key=lambda call: (place[call.module.file], call.node.lineno, call.node.col_offset))
        return found

    def calls(self, name: str) -> list[Call]:
        """Return the calls to functions and methods with this name, such as "publish", in source order.

        If ALIKE maps another method to this name, the calls to that method are included.
        """
        return self._calls.get(name, [])

    def assigned(self, *path: str) -> Where | None:
        """Return the first place that sets an attribute such as ("linear", "x") by assignment or keyword, or None."""
        for module in self.modules:
            lines = [line for node in module.nodes for line in _sets(node, path)]
            if lines:
                return Where(module.file, min(lines))
        return None


def _sets(node: ast.AST, path: tuple[str, ...]) -> list[int]:
    if isinstance(node, ast.Assign):
        targets = node.targets
    elif isinstance(node, ast.AnnAssign | ast.AugAssign):
        targets = [node.target]
    elif isinstance(node, ast.keyword) and node.arg == path[0] and isinstance(node.value, ast.Call):
        return [node.value.lineno for keyword in node.value.keywords if keyword.arg == path[-1]]
    else:
        return []
    return [
        target.lineno
        for target in targets
        if isinstance(target, ast.Attribute) and (dotted(target) or "").split(".")[-len(path) :] == list(path)
    ]


def read_code(files: Mapping[str, bytes], first: str | None) -> Code:
    """Parse the node's file `first` and the submission's files that it imports.

    The files of other nodes are not needed, because they do not affect this node. Without `first`, parse all files
    except tests, launch files and setup.py. Raises TooLargeError if the files are too large or nested too deeply.
    """
    paths = {path: None for path in sorted(files) if path.endswith(".py") and not _left_out(path)}
    modules: dict[str, Module] = {}
    waiting = deque(paths if first is None else [first])
    left = MOST_BYTES
    while waiting:
        path = waiting.popleft()
        if path in modules:
            continue
        left -= len(files[path])
        if left < 0:
            message = f"its Python files are too large to be read: more than {MOST_BYTES // 1000} kB together"
            raise TooLargeError(message)
        modules[path] = read_module(path, files[path])
        if first is not None:
            found = [*imported_files(modules[path], paths), *_packages_around(path, paths)]
            waiting += [file for file in dict.fromkeys(found) if file not in modules]
    return Code(tuple(modules.values()), first)


def _packages_around(path: str, paths: Collection[str]) -> list[str]:
    """Return the __init__.py files that Python runs before the file at this path."""
    folders = path.split("/")[:-1]
    around = ["/".join([*folders[:depth], "__init__.py"]) for depth in range(len(folders), 0, -1)]
    return [file for file in around if file in paths]


def imported_files(module: Module, paths: Collection[str]) -> list[str]:
    """Return those files in `paths` that a module imports, by absolute or relative imports."""
    found: list[str] = []
    for node in module.nodes:
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            folder = module.file.split("/")[: -node.level] if node.level else []
            base = ".".join([*folder, *([node.module] if node.module else [])])
            # No file name is this long, and many such names would take too much memory.
            names = [base, *(f"{base}.{alias.name}" for alias in node.names)] if len(base) <= MAX_NAME else []
        else:
            continue
        found += [file for name in names if (file := module_file(name, paths)) is not None]
    return found


def imported_packages(code: Code, paths: Collection[str]) -> dict[str, Where]:
    """Return the imported packages that are outside the submission, with the line of each first import.

    An import inside `try` or `if` is optional, so it does not count.
    """
    found: dict[str, Where] = {}
    for module in code.modules:
        for node in sorted(_required_imports(module.body), key=lambda each: each.lineno):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            else:
                names = [node.module] if node.module and not node.level else []
            for name in names:
                package = name.partition(".")[0]
                if module_file(name, paths) is None and module_file(package, paths) is None:
                    found.setdefault(package, Where(module.file, node.lineno))
    return found


def _required_imports(body: Iterable[ast.AST]) -> Iterator[ast.Import | ast.ImportFrom]:
    waiting = list(body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        elif isinstance(node, ast.stmt) and not isinstance(node, ast.Try | ast.If):
            waiting += ast.iter_child_nodes(node)


def module_file(module: str, paths: Collection[str]) -> str | None:
    """Return the file of the submission that has this dotted module name, or None if no file has it."""
    path = module.replace(".", "/")
    candidates = (f"{root}{path}{end}" for root in ("", SRC) for end in (".py", "/__init__.py"))
    return next((each for each in candidates if each in paths), None)


def import_path(file: str) -> str:
    """Return the path from which a Python file is imported, without src/."""
    return file.removeprefix(SRC)


def _left_out(path: str) -> bool:
    folders = path.split("/")[:-1]
    return path == "setup.py" or path.startswith("launch/") or any(folder in ("test", "tests") for folder in folders)


def read_module(file: str, data: bytes) -> Module:
    """Parse one file. If Python cannot read the file, `unreadable` contains the reason.

    Raises:
        TooLargeError: the file is too large, or nested too deeply.
    """
    if len(data) > MAX_BYTES:
        message = f"{shorten(file)} is too large to be read: more than {MAX_BYTES // 1000} kB"
        raise TooLargeError(message)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore"
            )  # a warning about an escape sequence in the student's code must not appear in our output
            return Module(file, ast.parse(data, filename=file))
    except SyntaxError as error:
        return Module(file, unreadable=Unreadable(error.msg, error.lineno or None))
    except ValueError as error:  # before Python 3.12, null bytes raise ValueError
        return Module(file, unreadable=Unreadable(str(error)))
    except (RecursionError, MemoryError) as error:
        message = f"{shorten(file)} is nested too deeply to be read"
        raise TooLargeError(message) from error

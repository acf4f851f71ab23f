"""Clues in the source that a node may follow wall time, so that simulated time would misjudge it.

Only what the executable's module reaches inside the package counts: a sleep in another node of the package is no
reason to make this one wait.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_MODULES = {
    "time",
    "datetime",
    "threading",
    "asyncio",
    "subprocess",
    "multiprocessing",
    "concurrent",
    "sched",
    "signal",
}
_NAMES = {"spin_once", "sleep", "sleep_for", "sleep_until", "STEADY_TIME", "SYSTEM_TIME", "timeout_sec"}


@dataclass(frozen=True)
class Clue:
    """What was found where: `name` as written ("time.sleep"), `file` relative to the package folder."""

    name: str
    file: str
    line: int


def wall_clues(files: Mapping[str, bytes], module: str | None) -> list[Clue]:
    """Find the clues in what `module` ("package.module") reaches; without a module, in the whole package."""
    trees: dict[str, tuple[str, ast.Module]] = {}
    for path, source in files.items():
        if path.endswith(".py") and path != "setup.py" and not path.startswith("test/"):
            try:
                trees[_module_name(path)] = (path, ast.parse(source))
            except (SyntaxError, ValueError, RecursionError, MemoryError):
                continue  # it cannot run either
    reached = _reach(trees, module) if module in trees else set(trees)
    return [clue for name in sorted(reached) for clue in _clues(*trees[name])]


def _module_name(path: str) -> str:
    parts = PurePosixPath(path).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _reach(trees: Mapping[str, tuple[str, ast.Module]], start: str) -> set[str]:
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        name = waiting.pop()
        if name in trees and name not in reached:
            reached.add(name)
            waiting += _imports(name, trees[name][1])
    return reached


def _imports(importer: str, tree: ast.Module) -> Iterator[str]:
    package = importer.rsplit(".", 1)[0]
    yield package
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package if node.level else ""
            module = ".".join(part for part in (base, node.module or "") if part)
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)


def _clues(path: str, tree: ast.Module) -> Iterator[Clue]:
    modules = dict(_wall_time_names(tree))
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in _NAMES:
            yield Clue(ast.unparse(node), path, node.lineno)
        elif isinstance(node, ast.keyword) and node.arg in _NAMES:
            yield Clue(node.arg, path, node.value.lineno)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in modules:
            yield Clue(modules[node.id], path, node.lineno)


def _wall_time_names(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """The names under which a file knows something of the modules that follow wall time, and what they stand for."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.split(".")[0] in _MODULES:
                    yield alias.asname or alias.name.split(".")[0], alias.name
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in _MODULES and not node.level:
            for alias in node.names:
                yield alias.asname or alias.name, f"{node.module}.{alias.name}"

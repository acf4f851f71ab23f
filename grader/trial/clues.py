"""Search the source of a node for clues that the node follows wall time.

In simulated time, a node that follows wall time could get a wrong verdict.

The search is limited to the executable's module and the modules of the package that it imports. A call to sleep in
another node of the package does not matter.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from grader.submission.code import module_file, read_code

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
    "select",
    "selectors",
    "signal",
    "timeit",
}
_NAMES = {
    "spin_once",
    "sleep",
    "sleep_for",
    "sleep_until",
    "STEADY_TIME",
    "SYSTEM_TIME",
    "timeout_sec",
    "throttle_duration_sec",
    # In simulated time, the jumps of the clock have other lengths.
    "create_jump_callback",
    # A node that ignores the global arguments ignores use_sim_time too.
    "use_global_arguments",
}
_CLOCKS = {"Clock", "ROSClock"}
"""The names of clock classes. A clock that the program creates itself does not follow /clock."""
_UNWATCHED = "EventsExecutor"
"""The executor of rclpy.experimental. With this executor, the clock of a trial in simulated time could not start."""
_TIMELESS = {"threading.Lock", "threading.RLock", "threading.local", "threading.current_thread", "threading.get_ident"}
"""Names from `threading` that are not clues, because nodes do not use them to wait for time to pass."""
MOST_NODES = 30
"""The maximum size of an expression that is shown in full (number of AST nodes)."""


@dataclass(frozen=True)
class Clue:
    """A clue, such as "time.sleep" (also after `from time import sleep`), and its place in the source.

    `file` is relative to the package folder.
    """

    name: str
    file: str
    line: int


def wall_clues(files: Mapping[str, bytes], module: str | None) -> list[Clue]:
    """Return the clues in `module` ("package.module") and in the modules that it imports.

    Without a module, search the whole package.
    """
    first = None if module is None else module_file(module, files)
    read = read_code(files, first).modules
    return [clue for each in read if each.tree is not None for clue in _clues(each.file, each.tree)]


def _clues(path: str, tree: ast.Module) -> Iterator[Clue]:
    modules = {name: stands for name, stands in _wall_time_names(tree) if stands not in _TIMELESS}
    timeless = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Attribute) and _is_timeless(node, modules)
    }
    for node in ast.walk(tree):
        if id(node) in timeless:
            continue
        if isinstance(node, ast.Attribute) and node.attr in _NAMES:
            yield Clue(_short(node), path, node.lineno)
        elif isinstance(node, ast.keyword) and node.arg in _NAMES:
            yield Clue(node.arg, path, node.value.lineno)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in modules:
            yield Clue(modules[node.id], path, node.lineno)
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in _CLOCKS:
            yield Clue("a clock of its own", path, node.lineno)
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) == _UNWATCHED:
            yield Clue(_UNWATCHED, path, node.lineno)
        elif isinstance(node, ast.Constant) and node.value == "use_sim_time":
            yield Clue("use_sim_time", path, node.lineno)


def _short(node: ast.Attribute) -> str:
    """Return the source of the expression, or only the name of its attribute if the source is long.

    Each attribute in a long chain can be a clue. Without this limit, each of these clues would repeat the chain before
    it.
    """
    return ast.unparse(node) if len(list(islice(ast.walk(node), MOST_NODES + 1))) <= MOST_NODES else node.attr


def _is_timeless(node: ast.Attribute, modules: Mapping[str, str]) -> bool:
    return isinstance(node.value, ast.Name) and f"{modules.get(node.value.id)}.{node.attr}" in _TIMELESS


def _wall_time_names(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield each name that a file imports from a module that uses wall time, together with its full name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.split(".")[0] in _MODULES:
                    yield alias.asname or alias.name.split(".")[0], alias.name
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in _MODULES and not node.level:
            for alias in node.names:
                yield alias.asname or alias.name, f"{node.module}.{alias.name}"

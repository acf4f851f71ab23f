"""Find out whether the random numbers of the tests are the same in every run, because of a fixed seed."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode

GENERATORS = frozenset({"Random", "RandomState", "default_rng"})
"""Functions of `random` and `numpy.random` that create a generator of random numbers."""
MODULES = frozenset({"random", "numpy.random"})


def is_seeded(code: TestCode, names: Collection[str]) -> bool:
    """Return whether the tests draw random numbers only after `seed`, or from generators with a fixed seed.

    `names` are the functions that return random numbers.
    """
    calls = [(_last(node), node) for node in _nodes(code) if isinstance(node, ast.Call)]
    seeds = [node for name, node in calls if name == "seed"]
    generators = [node for name, node in calls if name in GENERATORS]
    if not all(_has_fixed_seed(call) for call in (*seeds, *generators)):
        return False
    if seeds:
        return True
    return bool(generators) and not any(_draws_without_generator(module, names) for module in code.modules)


def _nodes(code: TestCode) -> Iterator[ast.AST]:
    return (node for module in code.modules for node in module.nodes)


def _last(call: ast.Call) -> str:
    return str(dotted(call.func) or getattr(call.func, "attr", "")).rpartition(".")[2]


def _has_fixed_seed(call: ast.Call) -> bool:
    """Return whether the first argument can be a fixed seed: neither missing nor None nor the result of a call."""
    arguments = [*call.args, *(keyword.value for keyword in call.keywords)]
    if not arguments or (isinstance(arguments[0], ast.Constant) and arguments[0].value is None):
        return False
    return not any(isinstance(node, ast.Call) for node in ast.walk(arguments[0]))


def _draws_without_generator(module: Module, names: Collection[str]) -> bool:
    """Return whether a file uses the functions of `random` or `numpy.random` themselves."""
    local = set()
    for node in module.nodes:
        if isinstance(node, ast.Import):
            local |= {alias.asname or alias.name for alias in node.names if alias.name in MODULES}
            local |= {f"{alias.asname or alias.name}.random" for alias in node.names if alias.name == "numpy"}
        elif isinstance(node, ast.ImportFrom) and node.module == "numpy":
            local |= {alias.asname or alias.name for alias in node.names if alias.name == "random"}
        elif isinstance(node, ast.ImportFrom) and node.module in MODULES and _imports(node, names):
            return True
    return any(
        isinstance(node, ast.Attribute) and node.attr in names and dotted(node.value) in local for node in module.nodes
    )


def _imports(node: ast.ImportFrom, names: Collection[str]) -> bool:
    return any(alias.name in names for alias in node.names)

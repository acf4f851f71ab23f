"""Find out whether the random numbers of the tests are the same in every run, because of a fixed seed."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.causes.weak_tests import last_name
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from grader.submission.code import Module
    from grader.submission.pytest_files import TestCode

GENERATORS = frozenset({"Random", "RandomState", "default_rng"})
"""Functions and classes of `random` and `numpy.random` that create a generator of random numbers."""
SEED = "seed"
NUMPY = "numpy.random"
MODULES = frozenset({"random", NUMPY})


def is_seeded(code: TestCode, names: Collection[str]) -> bool:
    """Return whether the tests draw random numbers only from modules and generators that have a fixed seed.

    `names` are the functions that return random numbers. Whether `seed` is called before the numbers are drawn is not
    examined.
    """
    calls = [(last_name(node.func), node) for node in _nodes(code) if isinstance(node, ast.Call)]
    fixed = [_has_fixed_seed(node) for name, node in calls if name in GENERATORS | {SEED}]
    drawn, seeded = _modules_of(code, names), _modules_of(code, (SEED,))
    return bool(fixed) and all(fixed) and drawn <= seeded


def _nodes(code: TestCode) -> Iterator[ast.AST]:
    return (node for module in code.modules for node in module.nodes)


def _has_fixed_seed(call: ast.Call) -> bool:
    """Return whether the first argument can be a fixed seed: it is given, is not None and contains no call."""
    arguments = [*call.args, *(keyword.value for keyword in call.keywords)]
    if not arguments or (isinstance(arguments[0], ast.Constant) and arguments[0].value is None):
        return False
    return not any(isinstance(node, ast.Call) for node in ast.walk(arguments[0]))


def _modules_of(code: TestCode, names: Collection[str]) -> set[str]:
    """Return the modules in MODULES whose functions with these names are used. Methods of a generator do not count."""
    return {found for module in code.modules for found in _modules_in(module, names)}


def _modules_in(module: Module, names: Collection[str]) -> Iterator[str]:
    local: dict[str, str] = {}
    for node in module.nodes:
        if isinstance(node, ast.Import):
            local |= {alias.asname or alias.name: alias.name for alias in node.names if alias.name in MODULES}
            local |= {f"{alias.asname or alias.name}.random": NUMPY for alias in node.names if alias.name == "numpy"}
        elif isinstance(node, ast.ImportFrom) and node.module == "numpy":
            local |= {alias.asname or alias.name: NUMPY for alias in node.names if alias.name == "random"}
        elif isinstance(node, ast.ImportFrom) and node.module in MODULES:
            yield from (node.module for alias in node.names if alias.name in names)
    for node in module.nodes:
        if isinstance(node, ast.Attribute) and node.attr in names and (owner := dotted(node.value)) in local:
            yield local[owner]

"""Find the functions that the executor calls, directly or through other functions."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from grader.submission.code import Module

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda

STARTS = frozenset({"Thread", "Timer", "start_new_thread", "submit", "to_thread", "run_in_executor"})
"""Functions that call one of their arguments in another thread."""
STRAIGHT = frozenset({"__init__", "main"})
"""Functions that the executor does not call. They do not count as callbacks, even where their names are used
without calling them."""


def functions_in_callbacks(modules: Iterable[Module]) -> Iterator[tuple[Module, Function]]:
    """Yield the lambdas and functions that are stored or passed on (not to a thread), and the functions they call."""
    functions: dict[str, list[tuple[Module, Function]]] = {}
    waiting: list[tuple[Module, Function]] = []
    passed: set[str] = set()
    for module in modules:
        called = {id(node.func) for node in module.nodes if isinstance(node, ast.Call)}
        in_threads = {id(node) for node in _in_threads(module)}
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                functions.setdefault(node.name, []).append((module, node))
            elif id(node) in in_threads:
                continue
            elif isinstance(node, ast.Lambda):
                waiting.append((module, node))
            elif (
                isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load) and id(node) not in called
            ):
                passed.add(node.id if isinstance(node, ast.Name) else node.attr)
    known = passed - STRAIGHT
    waiting += [each for name in sorted(known) for each in functions.get(name, ())]
    while waiting:
        module, function = waiting.pop()
        yield module, function
        called_here = {last_name(node) for node in inside(function) if isinstance(node, ast.Call)}
        new = (called_here & functions.keys()) - known - STRAIGHT
        known |= new
        waiting += [each for name in sorted(new) for each in functions[name]]


def _in_threads(module: Module) -> Iterator[ast.expr]:
    """Yield the arguments of calls that start a thread. If one is a function, a wait in it delays no callback."""
    for node in module.nodes:
        if isinstance(node, ast.Call) and last_name(node) in STARTS:
            yield from (*node.args, *(keyword.value for keyword in node.keywords))


def inside(function: Function) -> Iterator[ast.AST]:
    """Yield the syntax nodes of a function, except those inside functions and classes that it defines."""
    waiting: list[ast.AST] = list(function.body) if isinstance(function.body, list) else [function.body]
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            waiting += ast.iter_child_nodes(node)


def last_name(call: ast.Call) -> str:
    """Return the last part of the called function's name."""
    return getattr(call.func, "attr", getattr(call.func, "id", ""))

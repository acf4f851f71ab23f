"""Uses of functions, found by the last part of their names, even if the source gives the functions other names.

A search for calls to `sleep` does not find `from time import sleep as nap`, `nap = time.sleep`, `partial(time.sleep,
1)` or `getattr(time, "sleep")`. If a function in another file calls `sleep`, such a search does not find that call
either. Therefore, each mention that may refer to one of the functions counts as a use, and names in other files that
refer to one of the functions are followed.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from grader.submission.constants import dotted, evaluate
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from grader.submission.code import Module

BY_STRING = frozenset(
    {"getattr", "attrgetter", "methodcaller", "__getattribute__", "__getattr__", "get", "exec", "eval"}
)
"""Functions that take the name of a function, or source code, as a string."""


@dataclass(frozen=True)
class Use:
    """A use of a function, with its original `name` and its name as `written` in the source."""

    name: str
    written: str
    where: Where


@dataclass
class _File:
    """One file of the submission, and what the names in the file refer to."""

    module: Module
    functions: dict[str, str] = field(default_factory=dict)
    """Maps a local name to one of the functions, as in `from x import FUNCTION as LOCAL`."""
    modules: set[str] = field(default_factory=set)
    """Names that may refer to modules."""
    others: dict[str, Top] = field(default_factory=dict)
    """Maps a local name or MODULE.NAME that refers to a top-level name in another file to this file and name."""
    stored: set[str] = field(default_factory=set)
    """Attributes that the file itself assigns. For example, after `self.sleep = 0` the attribute is not a function."""


Top = tuple[str, str]
"""A file, and a name at the top level of that file."""


def uses_of(modules: Sequence[Module], file: str | None, names: Collection[str]) -> list[Use]:
    """Return all uses of the named functions in `file`, which is one of `modules`, in the order of the source."""
    files = {module.file: _read(module, modules, names) for module in modules}
    found = files.get(file or "")
    if found is None:
        return []
    reached = _reached([each for each in files.values() if each is not found], names)
    uses = [use for node in found.module.nodes for use in _use(node, found, names)]
    for node in found.module.nodes:
        written = dotted(node) if isinstance(node, ast.Name | ast.Attribute) else None
        top = found.others.get(written or "")
        if top in reached:
            uses.append(Use(reached[top], top[1], Where(found.module.file, getattr(node, "lineno", None))))
    return sorted(uses, key=lambda use: use.where.line or 0)


def _reached(files: Sequence[_File], names: Collection[str]) -> dict[Top, str]:
    """Return the top-level names that lead to one of the functions, each with the name of that function."""
    reached: dict[Top, str] = {}
    users: dict[Top, set[Top]] = {}
    for each in files:
        path = each.module.file
        reached |= {(path, local): name for local, name in each.functions.items()}
        for local, top in each.others.items():
            users.setdefault(top, set()).add((path, local))
        for bound, node in _below_top(each.module):
            reached |= {top: use.name for use in _use(node, each, names) for top in bound}
            written = dotted(node) if isinstance(node, ast.Name | ast.Attribute) else None
            if written is not None:
                users.setdefault(each.others.get(written, (path, written)), set()).update(bound)
    waiting = list(reached)
    while waiting:
        top = waiting.pop()
        for user in users.get(top, ()):
            if user not in reached:
                reached[user] = reached[top]
                waiting.append(user)
    return reached


def _below_top(module: Module) -> Iterator[tuple[set[Top], ast.AST]]:
    """For each top-level statement that defines names, yield the names with each syntax node. Skip imports."""
    for statement in module.body:
        bound = {(module.file, name) for name in _bound([statement])}
        if bound and not isinstance(statement, ast.Import | ast.ImportFrom):
            yield from ((bound, node) for node in ast.walk(statement))


def _bound(statements: Iterable[ast.stmt]) -> set[str]:
    """Return the names that these statements define in their own scope."""
    bound: set[str] = set()
    for statement in statements:
        if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            bound.add(statement.name)
        elif isinstance(statement, ast.Import | ast.ImportFrom):
            bound |= {alias.asname or alias.name.partition(".")[0] for alias in statement.names}
        elif isinstance(statement, ast.Assign):
            bound |= {
                node.id for target in statement.targets for node in ast.walk(target) if isinstance(node, ast.Name)
            }
        elif isinstance(statement, ast.AnnAssign | ast.AugAssign) and isinstance(statement.target, ast.Name):
            bound.add(statement.target.id)
    return bound


def _read(module: Module, modules: Sequence[Module], names: Collection[str]) -> _File:
    """Read a file, and determine from its imports (at any level) what the names in the file refer to."""
    found = _File(module)
    tops = {
        each.file.rpartition("/")[2].removesuffix(".py"): {name: (each.file, name) for name in _bound(each.body)}
        for each in modules
        if each is not module
    }
    for node in module.nodes:
        if isinstance(node, ast.Import):
            for alias in node.names:
                local = alias.asname or alias.name
                found.modules.add(local)
                found.others |= _below(local, tops.get(alias.name.rpartition(".")[2], {}))
        elif isinstance(node, ast.ImportFrom):
            _import_from(found, node, tops, names)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            found.stored.add(node.attr)
    return found


def _import_from(found: _File, node: ast.ImportFrom, tops: dict[str, dict[str, Top]], names: Collection[str]) -> None:
    inside = tops.get((node.module or "").rpartition(".")[2], {})
    for alias in node.names:
        local = alias.asname or alias.name
        if alias.name == "*":
            found.others |= inside
        elif alias.name in inside:
            found.others[local] = inside[alias.name]
        elif alias.name in tops:  # `from package import module`
            found.modules.add(local)
            found.others |= _below(local, tops[alias.name])
        elif alias.name in names:
            found.functions[local] = alias.name
        else:
            found.modules.add(local)


def _below(module: str, tops: dict[str, Top]) -> dict[str, Top]:
    return {f"{module}.{name}": top for name, top in tops.items()}


def _use(node: ast.AST, file: _File, names: Collection[str]) -> Iterable[Use]:
    """Yield a use if this syntax node uses one of the functions."""
    name: str | None = None
    written: str | None = None
    if isinstance(node, ast.Call):
        written = (dotted(node.func) or "").rpartition(".")[2] or getattr(node.func, "attr", "")
        name = written if written in names else _by_string(node, file, names) if written in BY_STRING else None
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
        name, written = file.functions.get(node.id), node.id
    elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr in names:
        if (dotted(node.value) or "") in file.modules or node.attr not in file.stored:
            name = written = node.attr
    elif isinstance(node, ast.Subscript) and _is_of_a_module(node.value):
        # time.__dict__["sleep"], vars(time)["sleep"]
        key = evaluate(node.slice, file.module.names)
        name = written = key if isinstance(key, str) and key in names else None
    elif isinstance(node, ast.MatchClass):
        # match time: case object(sleep=nap)
        name = written = next((each for each in node.kwd_attrs if each in names), None)
    if name is not None:
        yield Use(name, written or name, Where(file.module.file, getattr(node, "lineno", None)))


def _is_of_a_module(node: ast.expr) -> bool:
    """Return whether the expression can be the dictionary of a module."""
    return isinstance(node, ast.Call) or getattr(node, "attr", "") == "__dict__"


def _by_string(call: ast.Call, file: _File, names: Collection[str]) -> str | None:
    """Return the function whose name is a word in a string argument (a name or source code), or None."""
    for argument in (*call.args, *(keyword.value for keyword in call.keywords)):
        text = evaluate(argument, file.module.names)
        if isinstance(text, str):
            words: list[str] = re.findall(r"\w+", text[:10_000])
            found = next((word for word in words if word in names), None)
            if found is not None:
                return found
    return None

"""Find states that a node compares but never sets, for example because the name of the state is misspelt."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module


def unset_state(evidence: Evidence) -> Cause | None:
    """Return the cause if an attribute is compared with a string that the module never assigns to it, else None.

    Only attributes that are assigned nothing but strings count.
    """
    for module in evidence.code.modules:
        states = _assigned(module)
        for node in module.nodes:
            if not isinstance(node, ast.Compare) or len(node.ops) > 1 or not isinstance(node.ops[0], ast.Eq):
                continue
            name, state = dotted(node.left) or "", node.comparators[0]
            known = states.get(name)
            value = state.value if isinstance(state, ast.Constant) else None
            if known and None not in known and isinstance(value, str) and value not in known:
                text = f'Nothing sets {shorten(name)} to "{shorten(value)}", so this condition is never true.'
                return Cause("never-publishes", text, Where(module.file, node.lineno))
    return None


def _assigned(module: Module) -> dict[str, set[str | None]]:
    """Map each attribute of self to the strings that are assigned to it, and None for any other value.

    An attribute that may get a value in another way is left out, for example an attribute of the class.
    """
    found: dict[str, set[str | None]] = {}
    pairs = list(_pairs(module))
    for name, value in pairs:
        found.setdefault(name, set()).update(_strings(value))
    stored = [node.attr for node in module.nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)]
    named = {node.id for node in module.nodes if isinstance(node, ast.Name)}
    known = [name for name, _ in pairs]
    plain = {name: name.removeprefix("self.") for name in found}
    return {
        name: values
        for name, values in found.items()
        if stored.count(plain[name]) == known.count(name) and not {plain[name], "setattr"} & named
    }


def _pairs(module: Module) -> Iterator[tuple[str, ast.expr]]:
    """Yield each attribute of self that is assigned on its own or in a tuple, with the assigned value."""
    for node in module.nodes:
        targets: list[ast.expr] = []
        values: list[ast.expr] = []
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            targets, values = [node.target], [node.value]
        elif isinstance(node, ast.Assign):
            first, given = node.targets[0], node.value
            targets, values = list(node.targets), [given] * len(node.targets)
            if isinstance(first, ast.Tuple) and isinstance(given, ast.Tuple):
                targets, values = first.elts, given.elts
        for target, value in zip(targets, values, strict=False):
            if isinstance(target, ast.Attribute) and (dotted(target) or "").startswith("self."):
                yield dotted(target) or "", value


def _strings(value: ast.expr) -> set[str | None]:
    if isinstance(value, ast.IfExp):
        return _strings(value.body) | _strings(value.orelse)
    return {value.value if isinstance(value, ast.Constant) and isinstance(value.value, str) else None}

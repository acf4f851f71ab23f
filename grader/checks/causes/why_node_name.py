"""Explain why the node has another name: a remapping rule, another class, or an inherited name."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.no_entry_point import line
from grader.common.words import shorten
from grader.errors import TooLargeError
from grader.submission.code import MOST_BYTES, Code, read_module
from grader.submission.constants import dotted, evaluate
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call, Module

GIVERS = ("__init__", "create_node", "Node")
"""The functions that get the name of a node as their first argument."""


def why_node_name(evidence: Evidence, name: str) -> Cause:
    """Return the reason why the node has the name `name` (without a slash)."""
    rule = remapping_rule(evidence, ("__node", "__name"), name)
    if rule is not None:
        return Cause("node-name", "This remapping rule gives the node another name.", rule)
    calls = [call for giver in GIVERS for call in evidence.code.calls(giver)]
    of_name = next((call for call in calls if _name(call) == name), None)
    if of_name is not None:
        other = _inherited(evidence, of_name, name) or _of_another_class(evidence, of_name, name)
        other = other or _other_file(evidence, of_name, calls)
        if other is not None:
            return other
    first = of_name or next(iter(calls), None)
    where = first.where if first is not None else evidence.place("create_node", "__init__")
    return Cause("node-name", f"The node name is the {_argument(first)}.", where)


def _argument(call: Call | None) -> str:
    """Return a phrase for the argument that is the node name, with the function that gets this argument."""
    giver = dotted(call.node.func) if call is not None else None
    short = "super().__init__" if giver is None or giver.startswith("super") else giver.rpartition(".")[2]
    if call is not None and any(each.arg == "node_name" for each in call.node.keywords):
        return f"argument node_name of {shorten(giver) if giver and short == '__init__' else short}"
    if giver is None or short != "__init__":
        return f"first argument of {short}"
    return f"second argument of {shorten(giver)}, after self"


def remapping_rule(evidence: Evidence, olds: Collection[str], new: str) -> Where | None:
    """Return the place of a string that is a remapping rule from one of the names `olds` to the name `new`, or None.

    A longer string does not count, because it may be a docstring or a message that mentions the rule.
    """
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                old, _, given = node.value.partition(":=")
                if old.rpartition(":")[2] in olds and given.removeprefix("/") == new.removeprefix("/"):
                    return Where(module.file, node.lineno)
    return None


def _name(call: Call) -> object:
    """Return the name that the call gives to the node. `Node.__init__(self, "name")` gets it after self."""
    of_class = (dotted(call.node.func) or "").endswith(".__init__")
    return evaluate(call.argument(1 if of_class else 0, "node_name"), call.module.names)


def _classes(evidence: Evidence) -> Iterator[tuple[Module, ast.ClassDef]]:
    for module in evidence.code.modules:
        yield from ((module, node) for node in module.nodes if isinstance(node, ast.ClassDef))


def _class_of(call: Call) -> ast.ClassDef | None:
    """Return the class that contains the call, or None."""
    around = [node for node in call.module.nodes if isinstance(node, ast.ClassDef)]
    return next((each for each in around if any(node is call.node for node in ast.walk(each))), None)


def _inherited(evidence: Evidence, call: Call, name: str) -> Cause | None:
    """Return the cause if a class without a name of its own is derived from the class with this call, else None."""
    base = _class_of(call)
    for module, node in _classes(evidence):
        bases = [ast.unparse(each).rpartition(".")[2] for each in node.bases]
        if base is not None and base.name in bases and not _mentions(node, evidence.trial.node or ""):
            text = f"{node.name} inherits the name {shorten(name)} from {base.name}, which passes it to its base class."
            return Cause("node-name", text, Where(module.file, node.lineno))
    return None


def _mentions(node: ast.AST, text: str) -> bool:
    return any(isinstance(each, ast.Constant) and each.value == text for each in ast.walk(node))


def _of_another_class(evidence: Evidence, call: Call, name: str) -> Cause | None:
    """Return the cause if the function of the entry point uses a class of another file for this node, else None."""
    own = _class_of(call)
    module = next((each for each in evidence.code.modules if each.file == evidence.code.node_file), None)
    if own is None or module is None or module is call.module:
        return None
    function = (evidence.entry_point() or "").partition(":")[2].strip()
    for node in module.nodes:
        inside = ast.walk(node) if isinstance(node, ast.FunctionDef) and node.name == function else ()
        for each in inside:
            if isinstance(each, ast.Name) and each.id == own.name:
                text = f"{function} creates an object of {own.name}, whose node has the name {shorten(name)}."
                return Cause("node-name", text, Where(module.file, each.lineno))
    return None


def _other_file(evidence: Evidence, call: Call, calls: list[Call]) -> Cause | None:
    """Return the cause if a file to which the entry point does not lead creates a node with the right name."""
    wanted, files = evidence.trial.node, evidence.submission.files
    if call.module.file != evidence.code.node_file or any(_name(each) == wanted for each in calls):
        return None
    if call.module.file.endswith(f"/{evidence.trial.executable}.py"):
        return None  # the entry point leads to the file with its name
    known = {module.file for module in evidence.code.modules}
    left = MOST_BYTES
    for path in sorted(files):
        if path in known or not path.endswith(".py") or path.startswith("test/") or len(files[path]) > left:
            continue
        left -= len(files[path])
        try:
            code = Code((read_module(path, files[path]),))
        except TooLargeError:
            continue
        if any(_name(each) == wanted for giver in GIVERS for each in code.calls(giver)):
            here = call.module.file.rpartition("/")[2]
            text = (
                f"The entry point {evidence.trial.executable} leads to {here}. The node named {wanted} is in "
                f"{path.rpartition('/')[2]}."
            )
            return Cause("entry-point-other", text, line(evidence))
    return None

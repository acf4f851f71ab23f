"""Check that the tests use only the node's topics and clock, not the methods and attributes of its class."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.tests_written import code_of
from grader.common.words import shorten
from grader.submission.code import module_file, read_module
from grader.submission.constants import dotted
from grader.submission.pytest_files import Function
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

TEXT = (
    "If somebody renames a method or an attribute of the node, the tests fail, although the node is correct. "
    "Publish a pose, advance the clock, and look at the messages that arrive."
)
NUMBERS = (
    "A test that takes the expected number from the node accepts every number, even a wrong one. Write the numbers "
    "into the tests."
)


def promises(evidence: Evidence, _: NoParams) -> Finding:
    """The tests use neither the methods and attributes of the node's class, nor the constants of the node's module."""
    expected = "The tests use only the topics and the clock of the node, as another node would."
    spec = next((trial.tests for trial in evidence.exercise.trials if trial.tests is not None), None)
    if spec is None:
        return passed(expected)
    own = _own_names(evidence, spec.module, spec.name)
    modules = code_of(evidence).modules
    nodes = {spec.name}.union(*(_names_of_nodes(module, spec.name) for module in modules))
    for module in modules:
        for use in module.nodes:
            if isinstance(use, ast.ImportFrom) and use.module == spec.module:
                constants = _constants(evidence, spec.module) - {spec.name}
                other = next((each.name for each in use.names if each.name in constants), None)
                if other is not None:
                    cause = Cause("uses-own-names", NUMBERS, Where(module.file, use.lineno))
                    observed = f"The tests import {shorten(other)} from the node, which does not promise this name."
                    return failed(observed, expected, cause)
            if isinstance(use, ast.Attribute) and use.attr in own and _last(use.value) in nodes:
                written = shorten(ast.unparse(use), 60)
                cause = Cause("uses-own-names", TEXT, Where(module.file, use.lineno))
                return failed(f"The tests use {written}, which the node does not promise.", expected, cause)
    return passed(expected)


def _own_names(evidence: Evidence, module: str, name: str) -> set[str]:
    """Return the names of the methods and attributes that this class defines, except __init__ and similar names."""
    files = evidence.submission.files
    file = module_file(module, files)
    if file is None:
        return set()
    names: set[str] = set()
    for node in read_module(file, files[file]).nodes:
        if isinstance(node, ast.ClassDef) and node.name == name:
            names |= {each.name for each in node.body if isinstance(each, Function)}
            names |= {each.attr for each in ast.walk(node) if isinstance(each, ast.Attribute) and _sets_own(each)}
    return {each for each in names if not each.startswith("__")}


def _constants(evidence: Evidence, module: str) -> set[str]:
    """Return the names that this module assigns at its top level."""
    files = evidence.submission.files
    file = module_file(module, files)
    if file is None:
        return set()
    assigned = (each for each in read_module(file, files[file]).body if isinstance(each, ast.Assign | ast.AnnAssign))
    parts = (part for each in assigned for part in ast.walk(each) if isinstance(part, ast.Name))
    return {part.id for part in parts if isinstance(part.ctx, ast.Store)}


def _sets_own(node: ast.Attribute) -> bool:
    return isinstance(node.ctx, ast.Store) and isinstance(node.value, ast.Name) and node.value.id == "self"


def _names_of_nodes(module: Module, name: str) -> Iterator[str]:
    """Yield the names that refer to an object of this class.

    These are the names to which such an object is assigned (only the last part of a dotted name), and the names of
    functions that return or yield such an object.
    """
    known: set[str] = set()
    for node in module.nodes:
        if isinstance(node, ast.Assign) and _creates(node.value, name):
            known |= {_last(target) for target in node.targets}
    for node in module.nodes:
        if isinstance(node, Function):
            given = [each.value for each in ast.walk(node) if isinstance(each, ast.Yield | ast.Return)]
            if any(each is not None and (_creates(each, name) or _last(each) in known) for each in given):
                known.add(node.name)
    yield from known - {""}


def _creates(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Call) and _last(node.func) == name


def _last(node: ast.AST) -> str:
    """Return the last part of a dotted name, such as "guard" for `self.bench.guard`, or "" for other expressions."""
    return (dotted(node) or "").rpartition(".")[2] if isinstance(node, ast.expr) else ""


PROMISES = Kind(
    "tests_promises",
    "source",
    "The tests use only what the node promises",
    NoParams,
    promises,
    about="The test files do not use the methods and attributes that the class under test defines, and do not import "
    "constants from its module.",
)

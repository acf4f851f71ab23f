"""Mutants: files of the grader, each changed in one place by the operators of mutmut or by some of our own.

Only code that makes decisions is changed. Code for messages is not changed: strings, a choice between two strings,
printed numbers. Declarations, the parameters of a kind of check with their defaults, the `strict` of zip, and the code
that chooses the clock because a value is near a limit are not changed either. grader/tests/checks has tests for this
code.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING

import libcst as cst
from libcst.metadata import (
    MetadataWrapper,
    ParentNodeProvider,
    PositionProvider,
    WhitespaceInclusivePositionProvider,
)
from mutmut.mutation import mutators

from grader.checks.diagnoses import DIAGNOSES

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from libcst.metadata import CodeRange

LEFT_OUT = {
    mutators.operator_string,
    mutators.operator_dict_arguments,
    mutators.operator_arg_removal,
    mutators.operator_match,
}
"""The text of a finding does not change its diagnosis; other tests check the text. A match can cover several lines."""
IDS = frozenset(DIAGNOSES)
"""Strings that are not only text for readers."""
WORDS = frozenset({"shorten", "a_list", "count", "shown"})
"""Functions that create text. Numbers in their arguments do not change a diagnosis."""
STRINGS = cst.SimpleString | cst.FormattedString | cst.ConcatenatedString
MAKERS = {"failed": None, "Cause": 2}
"""Maps each function whose first argument is the id of a diagnosis to the index of the positional argument that states
the place."""
OTHER = cst.SimpleString('"another"')
KINDS = OUT, ALWAYS, NAME, PLACE, DETAIL = ("taken out", "always", "other name", "no place", "detail")
"""The effect of a change on a diagnosis. A "detail" is a change by one of mutmut's operators."""
Change = tuple[str, cst.CSTNode, cst.CSTNode]
"""A change: its kind, the old code and the new code."""


@dataclass(frozen=True)
class Mutant:
    """A file with one change. `line` and `end_line` are the first and last line of the statement, counted from 1.

    `change` is the text that is printed.

    `kind` is one of the strings in KINDS. `at_import` is true if the statement runs only when the file is imported.
    """

    file: Path
    line: int
    end_line: int
    kind: str
    change: str
    source: str
    at_import: bool = False

    def __str__(self) -> str:
        return f"{self.file.name}:{self.line}: {self.change}"


def mutants_of(file: Path) -> list[Mutant]:
    """Return every mutant of a file, in the order of its lines. Code that has no effect is not changed."""
    text = file.read_text("utf-8")
    wrapper = MetadataWrapper(cst.parse_module(text), unsafe_skip_copy=True)
    positions, parents = wrapper.resolve(PositionProvider), wrapper.resolve(ParentNodeProvider)
    spans = wrapper.resolve(WhitespaceInclusivePositionProvider)
    starts = [0, *accumulate(len(line) for line in text.splitlines(keepends=True))]

    def spliced(old: cst.CSTNode, new: cst.CSTNode) -> str:
        begin, end = (starts[each.line - 1] + each.column for each in (spans[old].start, spans[old].end))
        return text[:begin] + wrapper.module.code_for_node(new) + text[end:]

    found: dict[str, Mutant] = {}
    for node in positions:
        statement = _statement(node, parents)
        if statement is None or _idle(node, parents):
            continue
        place = _lines(statement, positions)
        for kind, old, new in () if _says_nothing(node, parents) else _changes(node):
            lead = "if " if isinstance(node, cst.If) else ""
            change = f"{lead}{_reported(wrapper.module, old)} -> {lead}{_reported(wrapper.module, new)}"
            source = spliced(old, new)
            found.setdefault(source, Mutant(file, *place, kind, change, source, _at_import(statement, parents)))
    found.pop(text, None)
    return sorted(found.values(), key=lambda mutant: mutant.line)


def _says_nothing(node: cst.CSTNode, parents: Mapping[cst.CSTNode, cst.CSTNode]) -> bool:
    """Return whether the statement is a `return None` without an effect, at the end of a function."""
    if not (isinstance(node, cst.Return) and isinstance(node.value, cst.Name) and node.value.value == "None"):
        return False
    line = parents[node]
    block = parents[line]
    return (
        isinstance(parents[block], cst.FunctionDef) and isinstance(block, cst.IndentedBlock) and block.body[-1] is line
    )


def _changes(node: cst.CSTNode) -> Iterator[Change]:
    """Yield the possible changes of this node."""
    for kind, operator in mutators.mutation_operators:
        if (
            isinstance(node, kind)
            and operator not in LEFT_OUT
            and not (isinstance(node, cst.Assign) and _is_words(node))
        ):
            yield from ((DETAIL, node, changed) for changed in operator(node))
    if isinstance(node, cst.If) and not (isinstance(node.test, cst.Name) and node.test.value == "TYPE_CHECKING"):
        yield OUT, node.test, cst.Name("False")
        yield ALWAYS, node.test, cst.Name("True")
    if isinstance(node, cst.Return | cst.Expr | cst.AugAssign | cst.Continue | cst.Break):
        yield OUT, node, cst.Pass()
    if isinstance(node, cst.Call) and isinstance(node.func, cst.Name) and node.func.value in MAKERS:
        yield NAME, node.args[0].value, OTHER
        yield from ((PLACE, place, cst.Name("None")) for place in _places(node, MAKERS[node.func.value]))
    if _is_id(node):
        yield NAME, node, OTHER


def _places(call: cst.Call, index: int | None) -> Iterator[cst.BaseExpression]:
    """Yield the arguments that state a place in the source: the argument at this index, and the keyword `where`."""
    for number, argument in enumerate(call.args):
        if number == index if argument.keyword is None else argument.keyword.value == "where":
            yield argument.value


def _is_words(assignment: cst.Assign) -> bool:
    """Return whether a variable contains text, or a distance from a limit that affects only the choice of the clock."""
    return _is_nearness(assignment) or _is_text(assignment.value) or _chooses_text(assignment.value)


def _is_nearness(assignment: cst.Assign) -> bool:
    target = assignment.targets[0].target
    return isinstance(target, cst.Name) and target.value.startswith("near")


def _is_text(value: cst.CSTNode) -> bool:
    """Return whether a node of the syntax tree is a string for readers and not a diagnosis id."""
    return isinstance(value, STRINGS) and not _is_id(value)


def _is_id(node: cst.CSTNode) -> bool:
    return isinstance(node, cst.SimpleString) and node.evaluated_value in IDS


def _chooses_text(value: cst.CSTNode) -> bool:
    return isinstance(value, cst.IfExp) and _is_text(value.body) and _is_text(value.orelse)


def _statement(node: cst.CSTNode, parents: Mapping[cst.CSTNode, cst.CSTNode]) -> cst.CSTNode | None:
    """Return the statement to which the node belongs."""
    here: cst.CSTNode | None = node
    while here is not None and not isinstance(here, cst.SimpleStatementLine | cst.BaseCompoundStatement):
        here = parents.get(here)
    return here


def _idle(node: cst.CSTNode, parents: Mapping[cst.CSTNode, cst.CSTNode]) -> bool:
    """Return whether a node of the syntax tree is only a declaration or only creates text."""
    if _is_docstring(node, parents) or _chooses_text(node):
        return True
    before, here = node, parents.get(node)
    while here is not None:
        if isinstance(here, cst.FunctionDef):
            return isinstance(before, cst.Parameters)
        if isinstance(here, cst.Annotation | cst.Decorator | cst.FormattedString | cst.ImportFrom | cst.ClassDef):
            return True
        if isinstance(here, cst.Call) and isinstance(here.func, cst.Name) and here.func.value in (*WORDS, "Kind"):
            return True
        if _chooses_text(here) or (isinstance(here, cst.Assign) and _is_nearness(here)):
            return True
        if isinstance(here, cst.Arg) and here.keyword is not None and here.keyword.value in ("near_edge", "strict"):
            return True
        before, here = here, parents.get(here)
    return False


def _at_import(statement: cst.CSTNode, parents: Mapping[cst.CSTNode, cst.CSTNode]) -> bool:
    here: cst.CSTNode | None = statement
    while here is not None and not isinstance(here, cst.FunctionDef):
        here = parents.get(here)
    return here is None


def _is_docstring(node: cst.CSTNode, parents: Mapping[cst.CSTNode, cst.CSTNode]) -> bool:
    line = node if isinstance(node, cst.SimpleStatementLine) else parents.get(node)
    if not isinstance(line, cst.SimpleStatementLine):
        return False
    first = line.body[0]
    return isinstance(first, cst.Expr) and isinstance(first.value, cst.SimpleString | cst.ConcatenatedString)


def _lines(statement: cst.CSTNode, positions: Mapping[cst.CSTNode, CodeRange]) -> tuple[int, int]:
    """Return the lines of a statement. For a compound statement, return only the lines of its header."""
    where = positions[statement]
    body = getattr(statement, "body", None)
    if isinstance(statement, cst.BaseCompoundStatement) and isinstance(body, cst.IndentedBlock):
        return where.start.line, max(where.start.line, positions[body].start.line - 1)
    return where.start.line, where.end.line


def _reported(module: cst.Module, node: cst.CSTNode) -> str:
    """Return a node's code on one line, short enough to print two such texts on a line."""
    text = " ".join(module.code_for_node(node).split())
    return text if len(text) <= 60 else f"{text[:57]}..."

"""Describe in a few sentences how the learner's file differs from the solution."""

from __future__ import annotations

import ast
from difflib import SequenceMatcher

from grader.common.words import a_list, count


def difference(theirs: str, ours: str, path: str) -> str:
    """Return one or more sentences about the differences between the learner's text and the solution's text."""
    if not theirs:
        return "Your work does not contain this file, or the file is empty or not UTF-8."
    mine, solution = (_parts(text) if path.endswith(".py") else None for text in (theirs, ours))
    if mine is None or solution is None:
        changes = SequenceMatcher(None, theirs.splitlines(), ours.splitlines(), autojunk=False).get_opcodes()
        lines = sum(max(a2 - a1, b2 - b1) for tag, a1, a2, b1, b2 in changes if tag != "equal")
        if not lines:
            return "Only line breaks differ."
        return f"{count(lines, 'line')} differ{'s' if lines == 1 else ''}."
    same = [name for name in solution if mine.get(name) == solution[name]]
    other = [name for name in solution if name in mine and name not in same]
    sentences = [
        _sentence("The code is the same in", same),
        _sentence("The code is different in", other),
        _sentence("Only your file has", [name for name in mine if name not in solution]),
        _sentence("Only the solution has", [name for name in solution if name not in mine]),
    ]
    if len(same) == len(solution) == len(mine):
        return "The code is the same. Only comments, docstrings or the layout differ."
    return " ".join(filter(None, sentences))


def _sentence(begin: str, names: list[str]) -> str:
    return f"{begin} {a_list(names)}." if names else ""


def _parts(text: str) -> dict[str, str] | None:
    """Return the code of each function and method by name, without its docstring, or None if the text has errors.

    The code outside functions is included as one more item, without docstrings.
    """
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return None
    found: dict[str, str] = {}
    rest = []
    for node in tree.body:
        members = [node]
        if isinstance(node, ast.ClassDef):
            members, node.body = node.body, []
            rest.append(ast.dump(node))
        for member in members:
            if isinstance(member, ast.FunctionDef | ast.AsyncFunctionDef):
                found[member.name] = found.get(member.name, "") + ast.dump(_without_docstring(member))
            elif not _is_text(member):
                rest.append(ast.dump(member))
    return {**found, "the lines outside functions": "\n".join(rest)}


def _without_docstring(function: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.AST:
    if function.body and _is_text(function.body[0]):
        function.body = function.body[1:]
    return function


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)

"""Explain why a student's test file cannot be imported."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import MEANINGS
from grader.common.words import nearest, shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.submission.pytest_files import TestCode

MODULE = re.compile(r"No module named '(?P<name>[\w.]+)'")
NAME = re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'")
RELATIVE = "attempted relative import"


def why_test_import(error: str, code: TestCode, node: tuple[str, str] | None, where: Where | None) -> Cause:
    """Return the cause of an exception that the import of a test file raised.

    `error` is the exception with its message. `node` is the module and the class of the node under test.
    """
    missing, name = MODULE.search(error), NAME.search(error)
    place = where if where is not None and where.line else _import_of(code, missing, name) or where
    if node is not None and (_is_like(missing, node[0]) or RELATIVE in error or _is_class(name, node)):
        text = f"The node is in the module {node[0]}: from {node[0]} import {node[1]}."
        return Cause("test-import", text, place)
    kind = error.partition(":")[0].rpartition(".")[2]
    return Cause("test-import", MEANINGS.get(kind, ""), place)


def _is_like(missing: re.Match[str] | None, module: str) -> bool:
    """Return whether the last part of the missing module's name is similar to that of the node's module."""
    if missing is None:
        return False
    last = missing["name"].rpartition(".")[2]
    known = (module.rpartition(".")[2], *module.split("."))
    return nearest(last, known) is not None or last == "src"


def _is_class(name: re.Match[str] | None, node: tuple[str, str]) -> bool:
    return name is not None and name["module"] == node[0] and nearest(name["name"], (node[1],)) is not None


def _import_of(code: TestCode, missing: re.Match[str] | None, name: re.Match[str] | None) -> Where | None:
    """Return the line that imports the missing module or name, or None."""
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Import | ast.ImportFrom) and _imports(node, missing, name):
                return Where(module.file, node.lineno)
    return None


def _imports(node: ast.Import | ast.ImportFrom, missing: re.Match[str] | None, name: re.Match[str] | None) -> bool:
    names = [each.name for each in node.names]
    paths = [node.module or ""] if isinstance(node, ast.ImportFrom) else names
    if missing is not None:
        return any(f"{path}.".startswith(f"{missing['name']}.") for path in paths)
    return name is not None and name["name"] in names and name["module"] in paths


def shown_error(error: str) -> str:
    """Return the exception without the path of the file in parentheses, which differs between machines."""
    return shorten(re.sub(r" \((?:/[^)]*|unknown location)\)", "", error), 120).rstrip(".")

"""Explain why pytest cannot collect the tests of a file that Python can import, mostly because of parametrize."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.weak_tests import last_name
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.submission.pytest_files import TestCode
    from grader.testbench.result import NodeRun

YIELDS = "'yield' keyword is allowed in fixtures, but not in tests"
OF_COLLECTION = re.compile(rf"parametrize|function uses no (?:argument|fixture) |{YIELDS}")
"""Matches pytest's messages about a test that it cannot collect, although the file can be imported."""
UNUSED = re.compile(r"function uses no (?:argument|fixture) '(?P<name>\w+)'")
YIELDING = re.compile(r"not in tests \((?P<name>\w+)\)")
FUNCTION = re.compile(r"\.py::(?:\w+::)*(?P<name>\w+)")
FORM = (
    "parametrize takes a string with the names, and a list with one tuple of values for each run, as in "
    'parametrize("a, b", [(1.0, 2.0), (3.0, 4.0)]).'
)


def of_collection(run: NodeRun) -> bool:
    """Return whether pytest could import a file but could not collect its tests."""
    return run.outcome == "import" and OF_COLLECTION.search(run.message) is not None


def why_not_collected(run: NodeRun, code: TestCode) -> Cause | None:
    """Return the cause if the arguments of parametrize do not fit a test, or if a test has a yield, else None."""
    if not of_collection(run) or "did you mean" in run.message:
        return None
    if YIELDS in run.message:
        yielding = YIELDING.search(run.message)
        name = yielding["name"] if yielding else ""
        text = f"{shorten(name, 60) or 'A test'} has a yield. Only a fixture has one."
        where = next((each.where for each in code.tests if each.node.name == name), None)
        return Cause("rejects-right", text, where)
    function = FUNCTION.search(run.message)
    places = dict(reversed(list(_parametrized(code))))
    first = next(reversed(places.values()), None)
    where = places.get(function["name"], first) if function else first
    unused = UNUSED.search(run.message)
    if unused is None:
        return Cause("test-parametrize", FORM, where)
    name = shorten(unused["name"], 40)
    text = f"parametrize has the name {name}, but the test has no parameter {name}. The names must be the same."
    return Cause("test-parametrize", text, where)


def _parametrized(code: TestCode) -> Iterator[tuple[str, Where]]:
    """Yield the name of each test that is parametrized, with the line of the decorator."""
    for test in code.tests:
        for each in test.node.decorator_list:
            if isinstance(each, ast.Call) and last_name(each.func) == "parametrize":
                yield test.node.name, Where(test.module.file, each.lineno)

"""The released notebook of a step, byte for byte identical to the output of nbgrader's generate_assignment.

This module repeats the steps of nbgrader 0.9 (LockCells, ClearSolutions, ClearOutput, ClearHiddenTests,
ComputeChecksums), so that a course can be released without Jupyter. A test compares the results with those of nbgrader.
"""

from __future__ import annotations

import hashlib
import json
import re
from typing import Any

from grader.errors import UsageError
from grader.exercise.markers import ANGLE, HASH, MEANT, Syntax, stripped, syntax_of

Cell = dict[str, Any]

_FILE_CELL = re.compile(r"\s*%%\w+[ \t]+(\S+)\s*")
_HIDDEN = {"BEGIN HIDDEN TESTS": True, "END HIDDEN TESTS": False}
"""nbgrader's markers for hidden tests. The value is True if hidden tests begin at the marker, and False if they end
there."""


def released_notebook(data: bytes, name: str) -> bytes:
    """Return the released version of a source notebook.

    Raises UsageError if the data is not a notebook or a cell has a mistake. The message contains `name` and, if a cell
    has a mistake, its number.
    """
    try:
        notebook = json.loads(data)
        for number, cell in enumerate(notebook["cells"], 1):
            _release(cell, f"{name}, cell {number}")
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        message = f"{name} is not a notebook ({error!r})."
        raise UsageError(message) from error
    return to_bytes(notebook)


def to_bytes(notebook: dict[str, Any]) -> bytes:
    """Return a notebook in the format of nbformat, so that opening and saving it changes nothing."""
    return (json.dumps(notebook, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def solved_away(source: str, cell_type: str, *, solution: bool, name: str) -> str:
    """Return the source of a cell with its solutions replaced by the starting point.

    Raises:
        UsageError: markers are wrong, or a solution cell has no markers, so that the whole solution would be released.
    """
    text = stripped(source, _syntax(source, cell_type), name)
    if solution and text == source:
        message = f"{name}: a solution cell has no BEGIN SOLUTION. The whole cell would be released."
        raise UsageError(message)
    return text


def without_hidden_tests(source: str, name: str) -> str:
    """Return a cell's source without its hidden tests. Raises UsageError if a begin or end marker is missing."""
    kept, hidden = [], False
    for line in source.splitlines(keepends=True):
        mark = next((begins for words, begins in _HIDDEN.items() if words in line), None)
        if mark is None:
            kept += [] if hidden else [line]
        elif mark == hidden:
            message = (
                f"{name}: {line.strip()!r}, but hidden tests {'have already begun' if hidden else 'have not begun'}."
            )
            raise UsageError(message)
        else:
            hidden = mark
    if hidden:
        message = f"{name}: BEGIN HIDDEN TESTS has no END HIDDEN TESTS."
        raise UsageError(message)
    # nbgrader also joins the lines that it keeps.
    return "".join(kept).removesuffix("\n") if len(kept) < len(source.splitlines()) else source


def _syntax(source: str, cell_type: str) -> Syntax:
    """Return the comment syntax of a cell: that of the file that the cell writes, or else that of the cell type."""
    match = _FILE_CELL.fullmatch(source.partition("\n")[0])
    if cell_type != "code":
        return ANGLE
    return (syntax_of(match[1]) or HASH) if match else HASH


def _release(cell: Cell, name: str) -> None:
    kind = cell["cell_type"]
    about = cell.get("metadata", {}).get("nbgrader")
    source = solved_away("".join(cell["source"]), kind, solution=bool(about and about["solution"]), name=name)
    hidden = without_hidden_tests(source, name)
    if hidden != source and not (about and about["grade"]):
        message = f"{name}: a cell that is not graded contains hidden tests."
        raise UsageError(message)
    if MEANT.search(hidden):
        message = f"{name}: a marker remains in the released cell."
        raise UsageError(message)
    cell["source"] = hidden.splitlines(keepends=True)
    if kind == "code":
        cell["outputs"] = []
        cell["execution_count"] = None
        for key in ("collapsed", "scrolled"):
            cell.get("metadata", {}).pop(key, None)
    if about and (about["grade"] or about["solution"] or about["locked"]):
        cell["metadata"]["deletable"] = False
        if not about["solution"]:
            cell["metadata"]["editable"] = False
        about["cell_type"] = kind
        about["checksum"] = _checksum(hidden, kind, about)


def _checksum(source: str, kind: str, about: dict[str, Any]) -> str:
    """Return nbgrader's checksum. The checksum shows whether a cell was changed, but anybody can compute it."""
    locked = not about["solution"] and (about["grade"] or about["locked"])
    parts = [source, kind, str(about["grade"]), str(about["solution"]), str(locked), about["grade_id"]]
    if about["grade"]:
        parts.append(str(float(about["points"])))
    return hashlib.md5("".join(parts).encode(), usedforsecurity=False).hexdigest()

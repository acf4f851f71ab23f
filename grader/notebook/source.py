"""The source notebook of a step: its words are written by hand, what stands elsewhere already is put in from there.

A cell that begins with `%%node`, `%%package` or `%%answers` gets the text of that file of the solution, markers and
all; and each check of exercise.toml has a grade cell of the same id and points, at the notebook's end.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from grader.errors import UsageError
from grader.notebook.place import MAGICS, part_path
from grader.notebook.released import Cell, to_bytes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.model import CheckSpec, Exercise

BEGIN = "begin"
"""The id of the cell that loads everything and names the step; locked."""


def refreshed(data: bytes, exercise: Exercise, files: Mapping[str, bytes], name: str) -> bytes:
    """The source notebook as it is to be. `files` are the solution's, by their path in the step's folder.

    Raises:
        UsageError: with `name` and cell, it is no notebook, or a cell writes a file that the solution does not have.
    """
    try:
        notebook: dict[str, Any] = json.loads(data)
        cells: list[Cell] = notebook["cells"]
        for number, cell in enumerate(cells, 1):
            _refresh(cell, exercise, files, f"{name}, cell {number}")
        notebook["cells"] = [cell for cell in cells if not _is_grade(cell)]
        notebook["cells"] += [_grade_cell(exercise, spec) for spec in exercise.checks]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        message = f"{name}: is no notebook ({error!r})."
        raise UsageError(message) from error
    return to_bytes(notebook)


def _refresh(cell: Cell, exercise: Exercise, files: Mapping[str, bytes], name: str) -> None:
    source = "".join(cell["source"])
    first = source.partition("\n")[0]
    if cell["cell_type"] == "code":
        cell["outputs"], cell["execution_count"] = [], None
    magic, _, argument = first.removeprefix("%%").partition(" ")
    if cell["cell_type"] != "code" or not first.startswith("%%") or magic not in MAGICS:
        return
    path = part_path(magic, argument.strip(), exercise)
    if path not in files:
        message = f"{name}: {first} writes {path}, which the solution does not have."
        raise UsageError(message)
    text = files[path].decode("utf-8")
    cell["source"] = f"{first}\n{text}".rstrip("\n").splitlines(keepends=True)
    # Not the cell's id alone: a check may be called "answers" too, and to nbgrader both are names of cells.
    cell["metadata"]["nbgrader"] = _about(f"write-{cell['id']}", solution=True)


def _is_grade(cell: Cell) -> bool:
    return bool(cell.get("metadata", {}).get("nbgrader", {}).get("grade"))


def _grade_cell(exercise: Exercise, spec: CheckSpec) -> Cell:
    lines = [f"# {spec.title}\n", f'check("{exercise.id}").points("{spec.id}")']
    if spec.hidden:
        lines = ["### BEGIN HIDDEN TESTS\n", lines[1] + "\n", "### END HIDDEN TESTS"]
    points = int(spec.points) if spec.points == int(spec.points) else spec.points
    return {
        "cell_type": "code",
        "execution_count": None,
        "id": f"grade-{spec.id}"[:64],
        "metadata": {"nbgrader": {**_about(spec.id, grade=True, locked=True), "points": points}},
        "outputs": [],
        "source": lines,
    }


def _about(name: str, *, grade: bool = False, solution: bool = False, locked: bool = False) -> dict[str, Any]:
    """The metadata by which nbgrader knows a cell (its schema 3)."""
    return {
        "grade": grade,
        "grade_id": name,
        "locked": locked,
        "schema_version": 3,
        "solution": solution,
        "task": False,
    }

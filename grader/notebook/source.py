"""The source notebook of a step: text written by hand, with inserted parts of the solution and of exercise.toml.

A cell that begins with `%%node`, `%%package` or `%%answers` gets the text of its file in the solution, including the
markers. The cells `begin` and `check` get the id of the step. At the end of the notebook, each check in
exercise.toml gets a grade cell with its id and points.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from grader.errors import UsageError
from grader.notebook.released import Cell, to_bytes
from grader.submission.notebook_cells import MAGICS, part_path

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.model import CheckSpec, Exercise

OF_STEP = {"begin": "%load_ext grader.notebook\n%step {}", "check": 'check("{}")'}
"""The source of each locked cell by its id. `{}` stands for the id of the step. `begin` loads the extension and sets
the step, and `check` prints the verdict."""


def refreshed(data: bytes, exercise: Exercise, files: Mapping[str, bytes], name: str) -> bytes:
    """Return the updated source notebook. `files` are the solution's files by their paths in the step's folder.

    Raises:
        UsageError: the data is not a notebook, or a cell writes a file that is not in the solution. The message
            contains `name` and, if a cell is wrong, its number.
    """
    try:
        notebook: dict[str, Any] = json.loads(data)
        cells: list[Cell] = notebook["cells"]
        for number, cell in enumerate(cells, 1):
            _refresh(cell, exercise, files, f"{name}, cell {number}")
        notebook["cells"] = [cell for cell in cells if not _is_grade(cell)]
        notebook["cells"] += [_grade_cell(exercise, spec) for spec in exercise.checks]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        message = f"{name} is not a notebook ({error!r})."
        raise UsageError(message) from error
    return to_bytes(notebook)


def _refresh(cell: Cell, exercise: Exercise, files: Mapping[str, bytes], name: str) -> None:
    source = "".join(cell["source"])
    first = source.partition("\n")[0]
    if cell["cell_type"] == "code":
        cell["outputs"], cell["execution_count"] = [], None
    if cell["cell_type"] == "code" and cell.get("id") in OF_STEP:
        cell["source"] = OF_STEP[cell["id"]].format(exercise.id).splitlines(keepends=True)
    magic, _, argument = first.removeprefix("%%").partition(" ")
    if cell["cell_type"] != "code" or not first.startswith("%%") or magic not in MAGICS:
        return
    path = part_path(magic, argument.strip(), exercise)
    if path not in files:
        message = f"{name}: {first} writes {path}, which is not in the solution."
        raise UsageError(message)
    text = files[path].decode("utf-8")
    cell["source"] = f"{first}\n{text}".rstrip("\n").splitlines(keepends=True)
    # Without the prefix, this name could be the id of a check, such as "answers", which is the name of a grade cell.
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
    """Return the metadata by which nbgrader recognizes a cell (schema 3)."""
    return {
        "grade": grade,
        "grade_id": name,
        "locked": locked,
        "schema_version": 3,
        "solution": solution,
        "task": False,
    }

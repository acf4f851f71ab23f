"""Check the outputs of an autograded notebook: their format, their length, and the points of graded cells."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import nbformat
from nbformat.v4 import new_code_cell, new_notebook, new_output

if TYPE_CHECKING:
    from nbformat import NotebookNode

MOST_OUTPUT = 4_000_000
"""The maximum number of characters of all outputs together. A notebook that prints more than this is stopped."""
TOO_MUCH = f"The notebook printed more than {MOST_OUTPUT // 1_000_000} million characters."


def mark(cell: NotebookNode, why: str) -> None:
    """Replace the output of a cell with the reason why the cell did not run or does not count."""
    cell.outputs = [new_output("error", ename="NotRun", evalue=why, traceback=[why])]  # type: ignore[no-untyped-call]


def honest(cell: NotebookNode) -> None:
    """Replace the outputs of a graded cell with an error if its result is not a number from 0 to the cell's points.

    Cells that do not call `.points()`, and cells that already have an error as an output, stay unchanged.

    Without this replacement, nbgrader would give full marks to a cell that has no output.
    """
    about = cell.get("metadata", {}).get("nbgrader", {})
    if not about.get("grade") or cell.cell_type != "code" or ".points(" not in cell.source:
        return
    results = [output for output in cell.outputs if output.output_type == "execute_result"]
    failed = any(output.output_type == "error" for output in cell.outputs)
    try:
        number = float(results[0]["data"]["text/plain"]) if len(results) == 1 else math.nan
    except (KeyError, TypeError, ValueError):
        number = math.nan
    if not failed and not 0.0 <= number <= float(about["points"]):
        mark(cell, "The cell did not return its points.")


def put_right(nb: NotebookNode) -> None:
    """Replace outputs that are too long or not valid for nbformat, so that the notebook can be written."""
    left = MOST_OUTPUT
    for cell in nb.cells:
        if cell.cell_type != "code":
            continue
        if not isinstance(cell.get("execution_count"), int | None):
            cell.execution_count = None
        # A single message may change many outputs, so check the total size at the end.
        for number, output in enumerate(cell.outputs):
            left -= _length(output)
            if left < 0:
                cell.outputs[number:] = []
                mark(cell, TOO_MUCH)
                break
        try:
            alone = new_code_cell(outputs=cell.outputs)  # type: ignore[no-untyped-call]
            nbformat.validate(new_notebook(cells=[alone]))  # type: ignore[no-untyped-call]
        except Exception:
            mark(cell, "The kernel sent an invalid output.")
    nb.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}


def _length(value: object) -> int:
    """Return the approximate number of characters of an output."""
    if isinstance(value, str):
        return len(value)
    if isinstance(value, dict):
        return sum(len(key) + _length(inner) for key, inner in value.items())
    return sum(map(_length, value)) if isinstance(value, list) else 8

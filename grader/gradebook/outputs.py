"""What autograde leaves in the cells of a notebook: outputs that are ones, not too many, and points that were given."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import nbformat
from nbformat.v4 import new_code_cell, new_notebook, new_output

if TYPE_CHECKING:
    from nbformat import NotebookNode

MOST_OUTPUT = 4_000_000
"""Characters of all outputs together; a notebook that prints more is ended."""
TOO_MUCH = f"The notebook printed more than {MOST_OUTPUT // 1_000_000} million characters."


def mark(cell: NotebookNode, why: str) -> None:
    """Replace what stands below a cell by the reason why it has not run, or does not count."""
    cell.outputs = [new_output("error", ename="NotRun", evalue=why, traceback=[why])]  # type: ignore[no-untyped-call]


def honest(cell: NotebookNode) -> None:
    """Replace the result of a cell that should give its points by an error if it is not a valid number.

    nbgrader gives full marks to a cell without output.
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
        mark(cell, "The cell did not give its points.")


def put_right(nb: NotebookNode) -> None:
    """See that the notebook can be written: what a kernel has put into it has to be what nbformat takes."""
    left = MOST_OUTPUT
    for cell in nb.cells:
        if cell.cell_type != "code":
            continue
        if not isinstance(cell.get("execution_count"), int | None):
            cell.execution_count = None
        # One message may have changed many outputs: only what is there in the end tells how much it is.
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
            mark(cell, "The kernel sent an output that is not one.")
    nb.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}


def _length(value: object) -> int:
    """Characters of an output, about."""
    if isinstance(value, str):
        return len(value)
    if isinstance(value, dict):
        return sum(len(key) + _length(inner) for key, inner in value.items())
    return sum(map(_length, value)) if isinstance(value, list) else 8

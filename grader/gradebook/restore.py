"""Restore the instructor's cells of a submitted notebook before it is graded.

nbgrader trusts the metadata of a submission, and stops if the metadata is invalid. From the metadata of a submitted
notebook, this step uses only the id of each cell. The gradebook determines the points and whether the cell is locked.
Missing locked cells are added again. If a cell exists several times, for example because the student copied it, the
last one counts, and the others become plain cells. Without these repairs, one invalid notebook would stop nbgrader from
grading the whole class.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nbformat.v4 import new_code_cell, new_markdown_cell
from nbgrader.api import Gradebook
from nbgrader.preprocessors import NbGraderPreprocessor
from nbgrader.utils import compute_checksum

if TYPE_CHECKING:
    from nbformat import NotebookNode


class RestoreCells(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """Restores the instructor's cells. nbgrader runs this step immediately after clearing the outputs."""

    def preprocess(self, nb: NotebookNode, resources: dict[str, Any]) -> tuple[NotebookNode, dict[str, Any]]:
        """Restore the cells that generate_assignment stored in the gradebook."""
        about = resources["nbgrader"]
        with Gradebook(about["db_url"]) as gradebook:
            notebook = gradebook.find_notebook(about["notebook"], about["assignment"])
            points = {cell.name: cell.max_score for cell in notebook.grade_cells}
            solutions = {cell.name for cell in notebook.solution_cells}
            known = {
                cell.name: (_metadata(cell, points.get(cell.name), solution=cell.name in solutions), cell.source)
                for cell in notebook.source_cells
            }
        last = {_name(cell): number for number, cell in enumerate(nb.cells)}
        observed: set[str] = set()
        cells = []
        for number, cell in enumerate(nb.cells):
            name = _name(cell)
            if name is None or name not in known or last[name] != number:
                cell.get("metadata", {}).pop("nbgrader", None)
                cells.append(cell)
                continue
            observed.add(name)
            metadata, source = known[name]
            cells.append(_cell(metadata, source if metadata["nbgrader"]["locked"] else cell.source))
        missing = [
            _cell(metadata, source)
            for name, (metadata, source) in known.items()
            if name not in observed and metadata["nbgrader"]["locked"]
        ]
        # Insert cells without points (such as the one that loads the magics) at the beginning, the others at the end.
        nb.cells = [
            *(cell for cell in missing if not cell.metadata.nbgrader.grade),
            *cells,
            *(cell for cell in missing if cell.metadata.nbgrader.grade),
        ]
        return nb, resources


def checksum(cell: Any, points: float, *, solution: bool) -> str:  # noqa: ANN401 - nbgrader's SourceCell
    """Return the checksum of an instructor's cell that is worth these points."""
    found: str = compute_checksum(_cell(_metadata(cell, points, solution=solution), cell.source))
    return found


def _name(cell: NotebookNode) -> str | None:
    about = cell.get("metadata", {}).get("nbgrader")
    name = about.get("grade_id") if isinstance(about, dict) else None
    return name if isinstance(name, str) else None


def _metadata(cell: Any, points: float | None, *, solution: bool) -> dict[str, Any]:  # noqa: ANN401 - nbgrader's SourceCell
    about = {
        "cell_type": cell.cell_type,
        "checksum": cell.checksum,
        "grade": points is not None,
        "grade_id": cell.name,
        "locked": cell.locked,
        "schema_version": 3,
        "solution": solution,
        "task": False,
    }
    return {"nbgrader": about if points is None else {**about, "points": points}}


def _cell(metadata: dict[str, Any], source: str) -> NotebookNode:
    make = new_code_cell if metadata["nbgrader"]["cell_type"] == "code" else new_markdown_cell
    return make(source, metadata=metadata)  # type: ignore[no-untyped-call, no-any-return, unused-ignore]

"""Read the provisional scores from the outputs of an autograded notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.errors import UnreadableError
from grader.submission.reader import read

if TYPE_CHECKING:
    from pathlib import Path


def kernel_scores(notebook: Path) -> dict[str, float | None] | None:
    """Return the points in the output of each graded cell, or None if there is no readable autograded notebook.

    The points are None for a cell that has not run, or whose output nbgrader cannot interpret.
    """
    try:
        return read(_scores_in, notebook)
    except UnreadableError:
        return None


def _scores_in(notebook: Path) -> dict[str, float | None]:
    from nbformat import read as read_notebook
    from nbgrader.utils import is_grade

    cells = read_notebook(notebook, as_version=4).cells  # type: ignore[no-untyped-call]
    return {cell.metadata.nbgrader.grade_id: _kernel_score(cell) for cell in cells if is_grade(cell)}


def _kernel_score(cell: Any) -> float | None:  # noqa: ANN401 - nbformat's NotebookNode
    from nbgrader.utils import determine_grade

    if cell.cell_type == "code" and cell.get("execution_count") is None:
        return None  # the kernel has not run this cell, for which nbgrader would give full points
    try:
        score: float | None = determine_grade(cell)[0]
    except (ValueError, AttributeError, KeyError, TypeError):
        return None  # an output that nbgrader cannot interpret
    return score

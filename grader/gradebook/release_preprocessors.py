"""Additional steps of `nbgrader generate_assignment` that insert starting points and strip solutions from files.

If a step finds a mistake, the step raises an error, so that nbgrader removes its output and no solution is released.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from nbgrader import utils
from nbgrader.preprocessors import NbGraderPreprocessor

from grader.authoring.release import release
from grader.notebook.released import solved_away

if TYPE_CHECKING:
    from nbformat import NotebookNode

Resources = dict[str, Any]


class StripSolutions(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """Replaces solutions as nbgrader's ClearSolutions does, but with the content of a STARTER block."""

    def preprocess_cell(
        self, cell: NotebookNode, resources: Resources, cell_index: int
    ) -> tuple[NotebookNode, Resources]:
        """Strip the solution from a cell. Raises UsageError if the markers in the cell are wrong."""
        name = f"{resources['nbgrader']['notebook']}.ipynb, cell {cell_index + 1}"
        cell.source = solved_away(cell.source, cell.cell_type, solution=utils.is_solution(cell), name=name)
        return cell, resources


class ReleaseFiles(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """Strips the solutions from the other files of the step, which nbgrader has copied unchanged."""

    def preprocess(self, nb: NotebookNode, resources: Resources) -> tuple[NotebookNode, Resources]:
        """Create the same release folder as `grader release`. nbgrader writes the notebook afterwards."""
        course = self.parent.parent.coursedir
        step = resources["nbgrader"]["assignment"]
        source = Path(course.format_path(course.source_directory, ".", step)).resolve()
        release(source, Path(course.format_path(course.release_directory, ".", step)).resolve())
        return nb, resources

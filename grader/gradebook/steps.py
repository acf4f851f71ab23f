"""Our steps of `nbgrader generate_assignment`: starting points instead of "YOUR CODE HERE", and stripped files.

Both raise an error if something is wrong, and nbgrader then removes what it has made. No solution must be released.
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
    """ClearSolutions with starting points: the content of a BEGIN STARTER block replaces the solution."""

    def preprocess_cell(
        self, cell: NotebookNode, resources: Resources, cell_index: int
    ) -> tuple[NotebookNode, Resources]:
        """Strip one cell. Raises UsageError for wrong markers."""
        name = f"{resources['nbgrader']['notebook']}.ipynb, cell {cell_index + 1}"
        cell.source = solved_away(cell.source, cell.cell_type, solution=utils.is_solution(cell), name=name)
        return cell, resources


class ReleaseFiles(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """Strip the step's other files, which nbgrader has copied unchanged."""

    def preprocess(self, nb: NotebookNode, resources: Resources) -> tuple[NotebookNode, Resources]:
        """Make the same release folder as `grader release`. Then nbgrader writes the notebook."""
        course = self.parent.parent.coursedir
        step = resources["nbgrader"]["assignment"]
        source = Path(course.format_path(course.source_directory, ".", step)).resolve()
        release(source, Path(course.format_path(course.release_directory, ".", step)).resolve())
        return nb, resources

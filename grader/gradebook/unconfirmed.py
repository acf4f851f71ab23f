"""A step of `nbgrader autograde` that replaces SaveAutoGrades. No check of the course gets points from a kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nbgrader.preprocessors import SaveAutoGrades
from nbgrader.utils import is_solution

from grader.exercise.model import catalogue
from grader.gradebook.confirmed import withhold

if TYPE_CHECKING:
    from nbformat import NotebookNode


class SaveUnconfirmed(SaveAutoGrades):  # type: ignore[misc, unused-ignore]
    """Sets the checks of the course's exercises to 0 points and "needs manual grade" until `sync` confirms a score."""

    def _add_score(self, cell: NotebookNode, resources: dict[str, Any]) -> None:
        if self.assignment_id not in catalogue() or cell.cell_type != "code" or is_solution(cell):
            super()._add_score(cell, resources)
            return
        name = cell.metadata["nbgrader"]["grade_id"]
        withhold(self.gradebook.find_grade(name, self.notebook_id, self.assignment_id, self.student_id))
        self.gradebook.db.commit()

"""Additional steps of `nbgrader generate_feedback` that add the grader's reasons and remove hidden tests."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nbformat.v4 import new_output
from nbgrader.preprocessors import ClearHiddenTests, NbGraderPreprocessor

from grader.classroom.results import Results
from grader.gradebook.class_folders import CLASS, RESULTS
from grader.notebook.grading_process import reason
from grader.report.hidden import for_students

if TYPE_CHECKING:
    from nbformat import NotebookNode

    from grader.report.report import Report

Resources = dict[str, Any]


class HideHiddenTests(ClearHiddenTests):  # type: ignore[misc, unused-ignore]
    """Removes from the feedback the lines of hidden tests, and all outputs of a kernel that has run hidden tests.

    Student code in the kernel can store the source of a hidden test and print it below any cell: below a later cell,
    below an instructor's cell (with a hook), below an earlier cell (by updating its display), or in a widget.
    Therefore, the outputs of a notebook with hidden tests are not shown.
    """

    def preprocess(self, nb: NotebookNode, resources: Resources) -> tuple[NotebookNode, Resources]:
        """Remove hidden tests from the notebook."""
        if any(self._is_hidden(cell) for cell in nb.cells):
            nb.metadata.pop("widgets", None)
            for cell in nb.cells:
                if cell.cell_type == "code":
                    cell.outputs = [_text(_points(cell))] if _about(cell).get("grade") else []
                    cell.execution_count = None
        return super().preprocess(nb, resources)  # type: ignore[no-any-return, unused-ignore]

    def preprocess_cell(
        self, cell: NotebookNode, resources: Resources, cell_index: int
    ) -> tuple[NotebookNode, Resources]:
        """Remove hidden tests from a cell."""
        if not self._is_hidden(cell):
            return cell, resources  # a student's cell may contain any text
        cell, resources = super().preprocess_cell(cell, resources, cell_index)
        if cell.cell_type == "code":
            cell.outputs = [_text(f"Hidden check: {_points(cell)}")]
        return cell, resources

    def _is_hidden(self, cell: NotebookNode) -> bool:
        return bool(_about(cell).get("grade")) and self.begin_test_delimeter in cell.source


def _about(cell: NotebookNode) -> dict[str, Any]:
    about: dict[str, Any] = cell.get("metadata", {}).get("nbgrader", {})
    return about


def _points(cell: NotebookNode) -> str:
    about = _about(cell)
    return f"{about.get('score') or 0:g} of {about['points']:g} points"


class GraderReasons(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """After a sync, shows the grader's reasons below cells with checks, in place of the kernel's output."""

    def preprocess(self, nb: NotebookNode, resources: Resources) -> tuple[NotebookNode, Resources]:
        """Replace the outputs of the cells if `sync` has stored a result for the submission."""
        about = resources["nbgrader"]
        folder = Path(self.parent.parent.coursedir.root) / CLASS / RESULTS
        result = Results(folder).load(about["student"], about["assignment"])
        if result is None:
            return nb, resources
        reasons = {outcome.id: reason(outcome) for outcome in result.report.outcomes}
        for cell in nb.cells:
            of_ours = cell.get("metadata", {}).get("nbgrader", {})
            name = of_ours.get("grade_id")
            if cell.cell_type != "code":
                continue
            if of_ours.get("grade") and name in reasons:
                cell.outputs = [_text(reasons[name])]
            elif of_ours.get("locked") and name == "check":
                cell.outputs = [_text(_whole(for_students(result.report)))]
        return nb, resources


def _text(text: str) -> NotebookNode:
    return new_output("stream", name="stdout", text=text + "\n")  # type: ignore[no-untyped-call, no-any-return, unused-ignore]


def _whole(report: Report) -> str:
    from rich.console import Console

    from grader.report import terminal

    page = io.StringIO()
    terminal.render(report, Console(file=page, width=100, highlight=False, force_terminal=False, color_system=None))
    return page.getvalue()

"""Our steps of `nbgrader generate_feedback`: the grader's own reasons, and nothing of what is hidden."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nbformat.v4 import new_output
from nbgrader.preprocessors import ClearHiddenTests, NbGraderPreprocessor

from grader.classroom.results import Results
from grader.gradebook.folders import CLASS, RESULTS
from grader.notebook.worker import reason
from grader.report.hidden import for_students

if TYPE_CHECKING:
    from nbformat import NotebookNode

    from grader.report.report import Report

Resources = dict[str, Any]
BEGIN = ClearHiddenTests.begin_test_delimeter.default_value


class HideHiddenTests(ClearHiddenTests):  # type: ignore[misc, unused-ignore]
    """Takes hidden tests out of the feedback: their lines, and what they printed or raised, which tells as much."""

    def preprocess_cell(
        self, cell: NotebookNode, resources: Resources, cell_index: int
    ) -> tuple[NotebookNode, Resources]:
        """Hide what is hidden in one cell."""
        hidden = BEGIN in cell.source
        cell, resources = super().preprocess_cell(cell, resources, cell_index)
        if hidden and cell.cell_type == "code":
            about = cell.metadata.nbgrader
            cell.outputs = [_text(f"Hidden check: {about['score']:g} of {about['points']:g} points")]
        return cell, resources


class GraderReasons(NbGraderPreprocessor):  # type: ignore[misc, unused-ignore]
    """Puts the grader's own reasons below the cells of checks, in place of what the kernel said; after sync."""

    def preprocess(self, nb: NotebookNode, resources: Resources) -> tuple[NotebookNode, Resources]:
        """Replace these outputs, if the submission was synced."""
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

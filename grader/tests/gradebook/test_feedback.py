"""Hidden tests do not appear in the feedback, no matter where the kernel that ran them prints them."""

from __future__ import annotations

from typing import Any

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output

from grader.gradebook.feedback import HideHiddenTests

SECRET = "the number is 4711"
HIDDEN = f"1\n### BEGIN HIDDEN TESTS\nassert answer == 4711, '{SECRET}'\n### END HIDDEN TESTS"


def cell(source: str, *outputs: Any, **about: Any) -> Any:  # noqa: ANN401 - nbformat's
    metadata = (
        {"nbgrader": {"grade": False, "locked": True, "grade_id": source[:5], "points": 2, **about}} if about else {}
    )
    return new_code_cell(source, outputs=list(outputs), metadata=metadata, execution_count=3)  # type: ignore[no-untyped-call]


def printed(text: str = SECRET) -> Any:  # noqa: ANN401
    return new_output("stream", name="stdout", text=text)  # type: ignore[no-untyped-call]


def shown(data: dict[str, str]) -> Any:  # noqa: ANN401
    return new_output("display_data", data=data)  # type: ignore[no-untyped-call]


def fed_back(*cells: Any, **metadata: Any) -> str:  # noqa: ANN401
    notebook = new_notebook(cells=list(cells), metadata=metadata)  # type: ignore[no-untyped-call]
    resources = {"nbgrader": {"student": "somebody", "assignment": "a", "notebook": "a", "db_url": ""}}
    notebook, _ = HideHiddenTests().preprocess(notebook, resources)
    text: str = nbformat.writes(notebook)  # type: ignore[no-untyped-call]
    return text


@pytest.mark.parametrize(
    "cells",
    [
        (cell(HIDDEN, printed(), grade=True, score=0.0),),
        (cell(HIDDEN, grade=True, score=1.0), cell("my = 1", printed())),
        (cell("my = 1", printed()), cell(HIDDEN, grade=True, score=1.0)),
        (cell(HIDDEN, grade=True, score=1.0), cell("check()", printed(), grade=False)),
        (cell(HIDDEN, grade=True, score=1.0), cell("shown", printed(), grade=True, score=2.0)),
        (cell(HIDDEN, grade=True, score=1.0), cell("my = 1", shown({"text/html": f"<b>{SECRET}</b>"}))),
    ],
    ids=["its own", "a later cell", "an earlier cell", "an instructor's cell", "another check", "html"],
)
def test_no_output_of_a_kernel_that_ran_a_hidden_test_is_shown(cells: tuple[Any, ...]) -> None:
    said = fed_back(*cells)
    assert SECRET not in said
    assert "4711" not in said
    assert "Hidden check:" in said


def test_widgets_and_counters_do_not_reveal_a_hidden_test() -> None:
    counts = cell("my = 1")
    counts.execution_count = 4711
    widgets = {"application/vnd.jupyter.widget-state+json": {"state": {"x": {"state": {"value": SECRET}}}}}
    said = fed_back(cell(HIDDEN, grade=True, score=0.0), counts, widgets=widgets)
    assert SECRET not in said
    assert "4711" not in said


def test_points_replace_the_outputs() -> None:
    said = fed_back(cell(HIDDEN, printed(), grade=True, score=0.5), cell("shown", printed(), grade=True, score=2.0))
    assert "Hidden check: 0.5 of 2 points" in said
    assert "2 of 2 points" in said


def test_without_hidden_tests_a_students_outputs_stay() -> None:
    assert "my words" in fed_back(cell("my = 1", printed("my words")), cell("shown", grade=True, score=2.0))


def test_marks_of_hidden_tests_in_a_students_cell_have_no_effect() -> None:
    said = fed_back(cell("### BEGIN HIDDEN TESTS", printed("my words")), cell("x ### END HIDDEN TESTS"))
    assert "my words" in said

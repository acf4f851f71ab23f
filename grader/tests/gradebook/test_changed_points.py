"""Private checks that change the points of a check change the maximum points in nbgrader's gradebook."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

import nbformat
import pytest
from nbgrader.preprocessors import OverwriteCells

from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import STEP, Term, solve, too_slow

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.skipif(not bubblewrap.usable(), reason="submissions run only in a sandbox")
def test_no_score_is_above_its_maximum(tmp_path: Path) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    term.submit("anna", solve)
    term.submit("bert", too_slow)
    term.run("grader", "gradebook", "sync")
    assert table(term) == {"anna": (100, 100), "bert": (55, 100)}
    with term.gradebook() as gradebook:
        grade = gradebook.find_grade("rate", STEP, STEP, "bert")
        grade.manual_score, grade.needs_manual_grade = 15, False
        gradebook.db.commit()
        by_hand = gradebook.find_submission(STEP, "bert").score

    private = tmp_path / "private"
    (private / STEP).mkdir(parents=True)
    (private / STEP / "exercise.toml").write_text('schema = 2\n[[check]]\nid = "rate"\npoints = 40\n')
    said = term.run("grader", "gradebook", "sync", "--checks", str(private))
    assert f"Changed maximum points in the gradebook: {STEP} rate (20 to 40)." in said
    assert table(term) == {"anna": (120, 120), "bert": (by_hand, 120)}
    with term.gradebook() as gradebook:
        assert gradebook.find_grade("rate", STEP, STEP, "bert").needs_manual_grade
        assert gradebook.find_grade("rate", STEP, STEP, "anna").max_score == 40

    assert points_of_a_new_notebook(term)["rate"] == 40

    # Without the private checks, the points of the course count again.
    assert "rate (40 to 20)" in term.run("grader", "gradebook", "sync")
    assert table(term)["anna"] == (100, 100)
    assert points_of_a_new_notebook(term)["rate"] == 20


def points_of_a_new_notebook(term: Term) -> dict[str, float]:
    """Map each cell to its points in a notebook that `nbgrader autograde` prepares for its kernel."""
    notebook = nbformat.read(term.root / "exercises" / STEP / f"{STEP}.ipynb", as_version=4)  # type: ignore[no-untyped-call]
    database = f"sqlite:///{term.root}/class/gradebook.db"
    about = {"nbgrader": {"notebook": STEP, "assignment": STEP, "student": "clara", "db_url": database}}
    prepared, _ = OverwriteCells().preprocess(notebook, about)
    cells = [cell.metadata.nbgrader for cell in prepared.cells if "points" in cell.metadata.get("nbgrader", {})]
    return {cell.grade_id: cell.points for cell in cells}


def table(term: Term) -> dict[str, tuple[float, float]]:
    """Map each student to (score, maximum), as written by `nbgrader export`."""
    term.exported()
    with (term.root / "grades.csv").open(newline="") as opened:
        return {row["student_id"]: (float(row["score"]), float(row["max_score"])) for row in csv.DictReader(opened)}

"""The notebooks of the course match their exercises. Released notebooks hide what students must not see."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from grader.checks.exercises import find_exercise
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder
from grader.notebook.released import released_notebook, without_hidden_tests
from grader.notebook.source import refreshed

ROOT = course_folder().parent
STEPS = list(catalogue())


def cells_of(step: str, root: str = "solutions") -> list[dict[str, Any]]:
    cells: list[dict[str, Any]] = json.loads((ROOT / root / step / f"{step}.ipynb").read_text("utf-8"))["cells"]
    return cells


def about(cell: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = cell["metadata"].get("nbgrader", {})
    return found


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("root", ["solutions", "exercises"])
def test_each_check_has_a_grade_cell_with_its_id_and_points(step: str, root: str) -> None:
    graded = [
        (about(cell)["grade_id"], about(cell)["points"]) for cell in cells_of(step, root) if about(cell).get("grade")
    ]
    assert graded == [(spec.id, spec.points) for spec in find_exercise(step).checks]


@pytest.mark.parametrize("step", STEPS)
def test_all_cells_have_different_names(step: str) -> None:
    for names in ([about(cell).get("grade_id") for cell in cells_of(step)], [cell["id"] for cell in cells_of(step)]):
        known = [name for name in names if name is not None]
        assert len(known) == len(set(known))


@pytest.mark.parametrize("step", STEPS)
def test_every_file_with_a_solution_has_a_cell(step: str) -> None:
    written = "".join(about(cell).get("grade_id", "") for cell in cells_of(step) if about(cell).get("solution"))
    to_solve = with_a_solution(step)
    assert to_solve
    for name in to_solve:
        assert name.partition(".")[0].replace("_", "-") in written, name


def with_a_solution(step: str) -> list[str]:
    """Return the names of the files to complete in this step. Later steps contain the tasks of step 07 unchanged."""
    before = [ROOT / "solutions" / name for name in STEPS[: STEPS.index(step)]]
    return [
        path.name
        for path in (ROOT / "solutions" / step).rglob("*")
        if path.suffix in (".py", ".xml", ".toml")
        and "BEGIN SOLUTION" in (text := path.read_text("utf-8"))
        and not any(text == same.read_text("utf-8") for folder in before for same in folder.rglob(path.name))
    ]


@pytest.mark.parametrize("step", STEPS)
def test_a_notebook_is_short_and_names_the_lesson(step: str) -> None:
    prose = " ".join("".join(cell["source"]) for cell in cells_of(step) if cell["cell_type"] == "markdown")
    assert 60 <= len(prose.split()) <= 450
    assert "type `%lesson` in a new cell." in prose
    assert f"In the course's repository, the lesson is `course/{step}/lesson.md`" in prose
    # A notebook may be opened from any folder, so a link to a file could lead nowhere.
    assert re.findall(r"\]\((?!https://)", prose) == []


def notebook(*cells: dict[str, Any]) -> bytes:
    return json.dumps({"cells": list(cells), "metadata": {}, "nbformat": 4, "nbformat_minor": 5}).encode()


def code(source: str, **about: object) -> dict[str, Any]:
    meta = {"nbgrader": {"grade": False, "solution": False, "locked": False, "grade_id": "x", **about}} if about else {}
    return {"cell_type": "code", "id": "a", "source": source, "metadata": meta, "outputs": [1], "execution_count": 3}


def test_hidden_tests_are_not_released() -> None:
    source = "check()\n### BEGIN HIDDEN TESTS\nassert secret\n### END HIDDEN TESTS\nlast"
    text = released_notebook(notebook(code(source, grade=True, points=5)), "n").decode()
    assert json.loads(text)["cells"][0]["source"] == ["check()\n", "last"]
    assert "secret" not in text


@pytest.mark.parametrize(
    ("cell", "why"),
    [
        (code("x = 1", solution=True), "a solution cell has no BEGIN SOLUTION"),
        (code("### BEGIN HIDDEN TESTS\nx\n### END HIDDEN TESTS"), "a cell that is not graded contains hidden tests"),
        (code("### BEGIN HIDDEN TESTS\nx", grade=True, points=1), "has no END HIDDEN TESTS"),
        (code("### END HIDDEN TESTS\nx", grade=True, points=1), "but hidden tests have not begun"),
    ],
)
def test_a_notebook_that_would_release_too_much_is_an_error(cell: dict[str, Any], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        released_notebook(notebook(cell), "n")


def test_a_source_without_hidden_tests_stays_as_it_is() -> None:
    assert without_hidden_tests("a\nb\n", "n") == "a\nb\n"


def test_a_cell_for_a_file_that_the_solution_lacks_is_an_error() -> None:
    with pytest.raises(UsageError, match=r"n, cell 1: %%node other.py writes .*, which is not in the solution"):
        refreshed(notebook(code("%%node other.py\nx")), find_exercise("03"), {}, "n")


def test_a_source_is_brought_up_to_date() -> None:
    exercise = find_exercise("03")
    node = "my_robot_controller/my_robot_controller/a.py"
    text = refreshed(notebook(code("%%node a.py\nold"), code("old", grade=True)), exercise, {node: b"new\n"}, "n")
    cells = json.loads(text)["cells"]
    assert cells[0]["source"] == ["%%node a.py\n", "new"]
    assert [about(cell)["grade_id"] for cell in cells[1:]] == [spec.id for spec in exercise.checks]
    assert refreshed(text, exercise, {node: b"new\n"}, "n") == text

"""nbgrader's commands with our notebooks: generate_assignment agrees with `grader release`, and validate works."""

from __future__ import annotations

import filecmp
import json
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from grader.exercise.model import catalogue, course_folder
from grader.notebook.kernel import install
from grader.tests.gradebook.nbgrader_command import nbgrader
from grader.tests.gradebook.term import STEP, Term, with_cell

if TYPE_CHECKING:
    from pathlib import Path

ROOT = course_folder().parent
HIDDEN: dict[str, Any] = {
    "cell_type": "code",
    "execution_count": None,
    "id": "private",
    "metadata": {
        "nbgrader": {
            "grade": True, "grade_id": "private", "locked": True, "points": 1, "schema_version": 3, "solution": False,
            "task": False,
        }
    },
    "outputs": [],
    "source": "1\n### BEGIN HIDDEN TESTS\nassert 'a secret' == 'known'\n### END HIDDEN TESTS",
}  # fmt: skip


SPIES = """\
def spy(result):
    source = result.info.raw_cell
    if "BEGIN HIDDEN" in source:
        print("FO" + "UND", source)

get_ipython().events.register("post_run_cell", spy)
"""


def same(one: Path, other: Path) -> bool:
    found = filecmp.dircmp(one, other)
    _, different, odd = filecmp.cmpfiles(one, other, found.common_files, shallow=False)
    whole = not (found.left_only or found.right_only or different or odd)
    return whole and all(same(one / name, other / name) for name in found.common_dirs)


def generated(term: Term, step: str) -> None:
    """Generate the assignment and compare it with the result of `grader release`."""
    exercise = term.root / "exercises" / step
    kept = term.root / "kept" / step
    shutil.copytree(exercise, kept)
    (exercise / "left-over.txt").write_text("of an older release")
    term.run("generate_assignment", step)
    assert same(exercise, kept)


def test_generate_assignment_makes_what_grader_release_makes(tmp_path: Path) -> None:
    generated(Term(tmp_path), STEP)


@pytest.mark.exhaustive
def test_generate_assignment_makes_what_grader_release_makes_of_every_step(tmp_path: Path) -> None:
    term = Term(tmp_path)
    for step in catalogue():
        generated(term, step)


def test_a_solution_that_would_be_released_stops_generate_assignment(tmp_path: Path) -> None:
    term = Term(tmp_path)
    node = term.root / "solutions" / STEP / "my_robot_controller/my_robot_controller/draw_circle.py"
    node.write_text(node.read_text().replace("# END SOLUTION", "# THE END", 1))
    said = term.run("generate_assignment", STEP, fails=True)
    assert "BEGIN STARTER inside the SOLUTION block" in said
    assert not (term.root / "exercises" / STEP).exists()


@pytest.mark.exhaustive
def test_hidden_tests_are_neither_released_nor_in_the_feedback(tmp_path: Path) -> None:
    term = Term(tmp_path)
    source = term.root / "solutions" / STEP / f"{STEP}.ipynb"
    notebook = json.loads(source.read_text())
    notebook["cells"].append(HIDDEN)
    source.write_text(json.dumps(notebook))
    term.generate()
    assert "secret" not in (term.root / "exercises" / STEP / f"{STEP}.ipynb").read_text()
    term.hand_in("somebody", lambda folder: with_cell(folder, SPIES))
    term.grade()
    assert "a secret" in (term.root / "class/autograded/somebody" / STEP / f"{STEP}.ipynb").read_text()
    autograded = (term.root / "class/autograded/somebody" / STEP / f"{STEP}.ipynb").read_text()
    assert "FOUND " in autograded
    feedback = term.feedback("somebody")
    assert "secret" not in feedback
    assert "FOUND " not in feedback
    assert "Hidden check: 0 of 1 points" in feedback


def validated(step: str, root: str, home: Path) -> str:
    """Return the output of `nbgrader validate` for a copy of the notebook, since it executes the notebook in place."""
    folder = home / root / step
    shutil.copytree(ROOT / root / step, folder)
    argv = ("validate", "--Execute.timeout=600", "--Execute.startup_timeout=600", f"{step}.ipynb")
    return nbgrader(*argv, cwd=folder, JUPYTER_DATA_DIR=str(home / "jupyter"))[1]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))
    install()
    return tmp_path


def test_validate_accepts_only_a_finished_notebook(home: Path) -> None:
    assert "Success! Your notebook passes all the tests." in validated("02-discover-topics", "solutions", home)
    assert "VALIDATION FAILED" in validated("02-discover-topics", "exercises", home)


@pytest.mark.exhaustive
@pytest.mark.parametrize("step", list(catalogue()))
def test_source_notebooks_are_valid_and_released_ones_are_not(step: str, home: Path) -> None:
    assert "Success! Your notebook passes all the tests." in validated(step, "solutions", home)
    assert "VALIDATION FAILED" in validated(step, "exercises", home)

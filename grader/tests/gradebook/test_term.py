"""A whole school term, with the real nbgrader and its database.

The exported CSV contains exactly the scores of the students.
"""

from __future__ import annotations

import datetime as dt
import getpass
import json
import re
import shutil
from typing import TYPE_CHECKING

import pytest

from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import (
    LATER,
    NODE,
    SOLUTION,
    STEP,
    Notebook,
    Term,
    edit,
    solve,
    too_slow,
    unchanged,
    with_cell,
)

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")

FORGED = """\
class Verdict:
    def points(self, name):
        return Points(PROMISED)

class Points(float):
    def __eq__(self, other):
        return True
    def __hash__(self):
        return 0

def check(step):
    return Verdict()
"""


ENDLESS = """\
while True:
    try:
        while True:
            pass
    except KeyboardInterrupt:
        pass
"""


def forge(folder: Path, promised: str) -> None:
    with_cell(folder, FORGED.replace("PROMISED", promised))


def notebook_alone(folder: Path) -> None:
    """Hand in only a notebook, with the node in a cell that was never executed."""
    shutil.rmtree(folder / "my_robot_controller")

    def solved(cells: list[Notebook]) -> list[Notebook]:
        for cell in cells:
            if "".join(cell["source"]).startswith("%%node draw_circle.py"):
                cell["source"] = "%%node draw_circle.py\n" + (SOLUTION / NODE).read_text()
        return cells

    edit(folder, solved)


def cells_missing(folder: Path) -> None:
    solve(folder)
    edit(folder, lambda cells: [cell for cell in cells if "nbgrader" not in cell["metadata"]])


def metadata_wrong(folder: Path) -> None:
    def spoil(cells: list[Notebook]) -> list[Notebook]:
        for number, cell in enumerate(cells):
            about = cell["metadata"].get("nbgrader")
            if about and about["grade"]:
                wrong = [{**about, "points": 1000}, {"grade_id": 7}, "x", {**about, "grade": False}]
                cell["metadata"]["nbgrader"] = wrong[number % 4]
        return cells

    edit(folder, spoil)


def patched_away(folder: Path) -> None:
    def patch(cells: list[Notebook]) -> list[Notebook]:
        for cell in cells:
            if cell["metadata"].get("nbgrader", {}).get("grade"):
                cell["source"] = "100.0"
        return cells

    edit(folder, patch)
    with_cell(folder, "check = lambda step: type('Verdict', (), {'points': lambda self, name: None})()")


def never_ends(folder: Path) -> None:
    solve(folder)
    with_cell(folder, ENDLESS)


def kills_its_kernel(folder: Path) -> None:
    solve(folder)
    with_cell(folder, "import os\nos.kill(os.getpid(), 9)")


def empty(folder: Path) -> None:
    for entry in folder.iterdir():
        shutil.rmtree(entry) if entry.is_dir() else entry.unlink()


@pytest.fixture
def term(tmp_path: Path) -> Term:
    return Term(tmp_path, cell_s=20)  # one student's cell does not end


@pytest.mark.exhaustive
def test_a_short_term(term: Term) -> None:
    term.generate()
    term.hand_in("slow", too_slow)
    term.hand_in("forger", lambda folder: forge(folder, "5.0"))
    term.hand_in("late-typist", notebook_alone)
    term.grade()
    assert term.exported() == {"slow": (55, 0, 55), "forger": (15, 0, 15), "late-typist": (100, 0, 100)}

    # The false score of the kernel is reported, and the feedback contains the grader's reasons.
    said = term.run("grader", "gradebook", "compare")
    assert "forger 03-circle-publisher circle: kernel 5, grader 0" in said
    assert not {"slow", "late-typist"} & {line.split()[0] for line in said.splitlines()}
    assert "create_publisher is never called" in term.feedback("forger")

    # A manual grade stays.
    with term.gradebook() as gradebook:
        grade = gradebook.find_grade("circle", STEP, STEP, "slow")
        grade.manual_score = 12.5
        gradebook.db.commit()
    before = term.exported()
    assert before["slow"] == (67.5, 0, 67.5)
    assert "0 scores of 3 submissions changed. 1 manual grade kept" in term.run("grader", "gradebook", "sync", STEP)
    assert term.exported() == before

    # nbgrader would skip a submission whose autograding was killed.
    graded = term.root / "class/autograded/slow" / STEP
    notebook, mark = graded / f"{STEP}.ipynb", graded.with_name(f".{STEP}.unfinished")
    assert not mark.exists()
    whole = notebook.read_text("utf-8")
    notebook.write_text(re.sub(r'"execution_count": \d+', '"execution_count": null', whole))
    assert "slow 03-circle-publisher topic: kernel nothing, grader 10" in term.run("grader", "gradebook", "compare")
    mark.touch()
    assert "Removing the unfinished assignment" in term.run("autograde", STEP)
    assert not mark.exists()
    assert '"execution_count": 1' in notebook.read_text("utf-8")
    assert "1 manual grade kept" in term.run("grader", "gradebook", "sync", STEP)
    assert "slow" not in term.run("grader", "gradebook", "compare")
    assert term.exported() == before


@pytest.mark.exhaustive
def test_a_whole_term(term: Term) -> None:
    term.generate()
    with term.gradebook() as gradebook:
        gradebook.update_or_create_assignment(STEP, duedate=dt.datetime(2027, 3, 1, 12))  # noqa: DTZ001 - as nbgrader
    mine = term.root.parent / "home-of-a-student"
    mine.mkdir()
    (mine / "nbgrader_config.py").write_text(
        f"c = get_config()\nc.Exchange.root = {str(term.exchange)!r}\n"
        f"c.CourseDirectory.course_id = {term.root.name!r}\n"
    )
    term.run("fetch_assignment", STEP, cwd=mine)
    solve(mine / STEP)
    term.run("submit", STEP, cwd=mine)
    earned = {getpass.getuser(): 100.0}
    for student, change, points in (
        ("partly", too_slow, 55.0),
        ("wrong", unchanged, 15.0),
        ("empty", empty, 0.0),
        ("missing-cells", cells_missing, 100.0),
        ("wrong-metadata", metadata_wrong, 15.0),
        ("infinite-loop", never_ends, 100.0),
        ("kernel-killed", kills_its_kernel, 100.0),
        ("patched", patched_away, 15.0),
        ("equal-to-all", lambda folder: forge(folder, "1e9"), 15.0),
        ("resubmitted", unchanged, 15.0),
        ("notebook-alone", notebook_alone, 100.0),
    ):
        term.hand_in(student, change)
        earned[student] = points
    term.hand_in("late", solve, at=LATER)
    term.run("collect", STEP)
    term.run("autograde", STEP)
    term.run("grader", "gradebook", "sync")
    exported = term.exported()
    assert exported.pop("late") == (100, 100, 0)
    submitted_late = exported.pop(getpass.getuser())  # the time of this machine does not matter
    assert submitted_late[0] == 100
    assert exported == {name: (points, 0, points) for name, points in earned.items() if name in exported}
    assert len(exported) == 11

    term.hand_in("resubmitted", solve, at="2027-03-01 11:00:00 UTC")
    term.grade()
    exported = term.exported()
    assert exported["resubmitted"] == (100, 0, 100)
    assert exported["late"] == (100, 100, 0)
    kernels = term.run("grader", "gradebook", "compare")
    assert "kernel-killed 03-circle-publisher circle: kernel 0, grader 25" in kernels
    assert "infinite-loop 03-circle-publisher circle: kernel 0, grader 25" in kernels
    assert "patched 03-circle-publisher start: kernel 0, grader 5" in kernels
    assert "missing-cells" not in kernels
    assert "did not end in time" in json.dumps(
        json.loads((term.root / "class/autograded/infinite-loop" / STEP / f"{STEP}.ipynb").read_text())["cells"]
    )

    csv = (term.root / "grades.csv").read_bytes()
    assert "0 scores of 13 submissions changed." in term.grade()
    term.exported()
    assert (term.root / "grades.csv").read_bytes() == csv

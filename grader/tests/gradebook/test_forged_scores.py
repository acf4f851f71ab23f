"""Scores that the grader has not confirmed do not count. The tests use the real nbgrader and forged scores."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from grader.classroom.grade_class import grade_found
from grader.classroom.order import Order, sources_for
from grader.classroom.results import Results
from grader.classroom.task import set_aside
from grader.gradebook import scores
from grader.gradebook.class_folders import open_class
from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import STEP, Term, edit, too_slow, unchanged, with_cell

if TYPE_CHECKING:
    from pathlib import Path

    from grader.classroom.found import Found
    from grader.classroom.grade_class import Request
    from grader.classroom.results import Result
    from grader.gradebook.scores import Synced

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")

FULL_MARKS = """\
class Verdict:
    def points(self, name):
        return {"start": 5.0, "topic": 10.0, "circle": 25.0}.get(name, 10.0)

def check(step):
    return Verdict()
"""
"""Points that autograde accepts, because they are at most the maximum of each cell."""
ANOTHERS = "homework"
"""An assignment that is in the same gradebook but is not part of this course."""


def forge(folder: Path) -> None:
    with_cell(folder, FULL_MARKS)


def unreadable(folder: Path) -> None:
    """Create a notebook that forges scores and has a cell whose file would be inside another file."""
    forge(folder)
    edit(
        folder,
        lambda cells: [*cells, {**cells[2], "id": "odd", "source": "%%package package.xml/below\nx"}],
    )


def with_another_assignment(term: Term) -> None:
    cell: dict[str, Any] = {
        "cell_type": "code",
        "execution_count": None,
        "id": "one",
        "metadata": {
            "nbgrader": {
                "grade": True, "grade_id": "one", "locked": True, "points": 3, "schema_version": 3, "solution": False,
                "task": False,
            }
        },
        "outputs": [],
        "source": "assert 1 + 1 == 2",
    }  # fmt: skip
    folder = term.root / "solutions" / ANOTHERS
    folder.mkdir()
    notebook = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    (folder / f"{ANOTHERS}.ipynb").write_text(json.dumps(notebook))
    term.run("generate_assignment", ANOTHERS)
    shutil.copytree(term.root / "exercises" / ANOTHERS, term.root / "class" / "submitted" / "honest" / ANOTHERS)
    term.run("autograde", ANOTHERS)


def grades(term: Term, student: str) -> dict[str, tuple[float | None, float | None, bool]]:
    """Map each check to (automatic score, manual score, needs manual grade), as in nbgrader's database."""
    with term.gradebook() as gradebook:
        submission = gradebook.find_submission(STEP, student)
        return {
            grade.name: (grade.auto_score, grade.manual_score, grade.needs_manual_grade)
            for notebook in submission.notebooks
            for grade in notebook.grades
        }


def withheld(term: Term, student: str) -> bool:
    return all(auto == 0 and manual is None and waits for auto, manual, waits in grades(term, student).values())


def points_of(term: Term, assignment: str = STEP) -> dict[str, float]:
    """Map each student to the score for the assignment in the exported table."""
    import csv

    file = term.root / "grades.csv"
    term.run("export", "--to", str(file))
    with file.open(newline="") as opened:
        return {
            row["student_id"]: float(row["score"]) for row in csv.DictReader(opened) if row["assignment"] == assignment
        }


def sync_with_an_error_for(student: str, term: Term, monkeypatch: pytest.MonkeyPatch) -> Synced:
    """Run sync on a machine that fails while it grades this student's submission."""

    def failing(request: Request, found: tuple[Found, ...], say: Any, tell: Any) -> list[Result]:  # noqa: ANN401
        graded = grade_found(request, tuple(each for each in found if each.student != student), say, tell)
        order = Order(found, {}, sources_for(found, None), "none")
        for each in found:
            if each.student == student:
                done = set_aside(order.task(each), "The machine was out of memory.")
                graded.append(Results(request.out).save(student, done.report, order.key(each), done.page))
        return graded

    monkeypatch.setattr(scores, "grade_found", failing)
    return scores.sync(
        open_class(term.course), [], jobs=2, checks=None, trusted=False, say=lambda _: None, tell=lambda _: None
    )


@pytest.fixture(scope="module")
def term(tmp_path_factory: pytest.TempPathFactory) -> Term:
    term = Term(tmp_path_factory.mktemp("term"))
    term.run("generate_assignment", STEP)
    return term


def test_a_forged_score_never_counts(term: Term, monkeypatch: pytest.MonkeyPatch) -> None:
    term.submit("honest", too_slow)
    for student, change in (("forger", forge), ("gone", forge), ("unreadable", unreadable)):
        term.submit(student, change)
    with_another_assignment(term)
    term.run("autograde", STEP)

    # Before a sync, no score from a kernel is stored, and the gradebook needs manual grades.
    assert all(withheld(term, student) for student in ("honest", "forger", "gone", "unreadable"))
    assert points_of(term) == {"honest": 0, "forger": 0, "gone": 0, "unreadable": 0}
    said = term.run("grader", "gradebook", "compare")
    assert said == (
        f"The grader has not graded the submissions of {STEP} yet. First type: grader gradebook sync {STEP}\n"
    )

    # In this sync, the machine fails for one submission, a second one is missing, and a third one cannot be read.
    shutil.rmtree(term.root / "class" / "submitted" / "gone")
    done = sync_with_an_error_for("forger", term, monkeypatch)
    assert done.unjudged == ("forger",)
    reported = {each.student: each.why for each in done.unconfirmed}
    assert reported.keys() == {"forger", "gone", "unreadable"}
    assert "not judged" in reported["forger"]
    assert "could not be read" in reported["unreadable"]
    assert all(withheld(term, student) for student in ("forger", "gone", "unreadable"))
    assert points_of(term) == {"honest": 55, "forger": 0, "gone": 0, "unreadable": 0}
    assert not any(waits for _, _, waits in grades(term, "honest").values())
    assert "unreadable" in (term.root / "class" / "results" / "summary.csv").read_text()
    said = term.run("grader", "gradebook", "compare")
    assert f"forger {STEP} circle: kernel 25, grader 0, needs manual grading (not judged by the grader)" in said
    assert f"gone {STEP} circle: kernel 25, grader 0, needs manual grading" in said
    assert "honest" not in said

    # A manual grade counts and is not withheld.
    with term.gradebook() as gradebook:
        for student, manual in (("forger", 7.0), ("honest", 20.0)):
            grade = gradebook.find_grade("circle", STEP, STEP, student)
            grade.manual_score, grade.needs_manual_grade = manual, False
        gradebook.db.commit()
    with_manual = points_of(term)
    assert (with_manual["forger"], with_manual["honest"]) == (7, 75)
    sync_with_an_error_for("forger", term, monkeypatch)
    assert points_of(term) == with_manual
    assert grades(term, "forger")["circle"] == (0, 7, False)

    # After a new autograde, the kernel's score is provisional again, and the manual grade stays.
    term.run("autograde", STEP, "--student", "honest", "--force")
    term.run("autograde", STEP, "--student", "forger", "--force")
    again = points_of(term)
    assert (again["forger"], again["honest"]) == (7, 20)
    assert grades(term, "forger")["start"] == (0, None, True)

    # Assignments of other courses stay unchanged.
    assert points_of(term, ANOTHERS) == {"honest": 3, "forger": 0, "gone": 0, "unreadable": 0}


def test_an_export_alone_corrects_an_older_gradebook(term: Term) -> None:
    term.submit("earlier", unchanged)
    with term.gradebook() as gradebook:
        gradebook.add_student("earlier")
        for notebook in gradebook.add_submission(STEP, "earlier").notebooks:
            for grade in notebook.grades:
                grade.auto_score, grade.needs_manual_grade = grade.max_score, False
        gradebook.db.commit()
        assert gradebook.find_submission(STEP, "earlier").score == 100
    assert points_of(term)["earlier"] == 0
    assert withheld(term, "earlier")


def test_no_name_of_a_student_changes_the_exported_table(term: Term) -> None:
    forged = "anna,,,,100,0,100,100"
    with term.gradebook() as gradebook:
        for student in (forged, "=1+1", "two\nlines"):
            gradebook.add_student(student, last_name='Doe, "Jo"')
    exported = points_of(term)
    assert (exported[forged], exported["'=1+1"], exported["two lines"]) == (0, 0, 0)
    assert "anna" not in exported

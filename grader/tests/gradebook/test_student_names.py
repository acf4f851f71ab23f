"""A folder whose name is almost an id in the gradebook is reported, and never adds a second student."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.gradebook.student_names import unclear
from grader.tests.gradebook.term import STEP, Term, solve

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("folders", "enrolled", "reported"),
    [
        (["ada", "bob"], ["ada"], {}),
        (["ada"], ["Ada"], {"ada": "Rename the folder ada to Ada."}),
        (["zoe\u0308"], ["zo\u00eb"], {"zoe\u0308": "is the id in the gradebook."}),
        (["Ada", "ada"], [], dict.fromkeys(["Ada", "ada"], "Remove or rename all of these folders but one.")),
        (["Ada"], ["Ada", "ada"], {"Ada": "Ada and ada are one student id"}),
        (["Ada", "ada"], ["ada"], {"Ada": "Keep only one of the folders, with the name ada."}),
        (["ada", "ADA", "Ada"], ["ada"], dict.fromkeys(["ADA", "Ada"], "ada is the id in the gradebook.")),
    ],
)
def test_names_that_are_one_id_are_reported(folders: list[str], enrolled: list[str], reported: dict[str, str]) -> None:
    found = unclear(folders, enrolled)
    assert found.keys() == reported.keys()
    for name, part in reported.items():
        assert part in found[name].reason
        assert found[name].diagnosis == "similar-names"


@pytest.mark.parametrize("name", ["\x1b]0;a title\x07", "two\nlines", "r\u202eight"])
def test_a_name_that_cannot_be_printed_is_reported(name: str) -> None:
    assert unclear([name, "ada"], ["ada"])[name].diagnosis == "submission-name"


def test_another_spelling_of_an_id_does_not_take_the_points_of_the_student(tmp_path: Path) -> None:
    """Anybody can create the folder `Ada` in the exchange."""
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    with term.gradebook() as gradebook:
        gradebook.update_or_create_student("ada")
    term.submit("ada", solve)
    term.submit("Ada", lambda _: None)
    assert "Not graded: Ada and ada are one student id" in term.run("grader", "gradebook", "sync")
    with term.gradebook() as gradebook:
        assert [(each.student.id, each.score) for each in gradebook.assignment_submissions(STEP)] == [("ada", 100.0)]


def test_neither_autograde_nor_sync_adds_a_second_student(tmp_path: Path) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    with term.gradebook() as gradebook:
        gradebook.update_or_create_student("Ada")
    term.submit("ada", lambda _: None)
    assert "Not autograded: Ada and ada are one student id" in term.run("autograde", STEP)
    said = term.run("grader", "gradebook", "sync")
    assert "Not graded: Ada and ada are one student id" in said
    assert "Rename the folder ada to Ada." in said
    with term.gradebook() as gradebook:
        assert [student.id for student in gradebook.students] == ["Ada"]

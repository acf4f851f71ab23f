"""A folder whose name is almost an id in the gradebook is reported, and never adds a second student."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.gradebook.student_names import unclear
from grader.tests.gradebook.term import STEP, Term

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("folders", "enrolled", "reported"),
    [
        (["ada", "bob"], ["ada"], {}),
        (["ada"], ["Ada"], {"ada": "Rename the folder ada to Ada."}),
        (["zoe\u0308"], ["zo\u00eb"], {"zoe\u0308": "is the id in the gradebook."}),
        (["Ada", "ada"], [], dict.fromkeys(["Ada", "ada"], "Keep one of these folders")),
        (["Ada"], ["Ada", "ada"], {"Ada": "Ada and ada are one student id"}),
        (["Ada", "ada"], ["ada"], {"Ada": "Rename the folder Ada to ada.", "ada": "nbgrader db student remove"}),
    ],
)
def test_names_that_are_one_id_are_reported(folders: list[str], enrolled: list[str], reported: dict[str, str]) -> None:
    found = unclear(folders, enrolled)
    assert found.keys() == reported.keys()
    for name, part in reported.items():
        assert part in found[name].reason
        assert found[name].diagnosis == "similar-names"


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

"""Another program locks nbgrader's database, or the grader is killed, while `grader gradebook sync` is running."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest

from grader.classroom.grade_class import grade_found
from grader.errors import MachineError
from grader.gradebook import scores
from grader.gradebook.class_folders import open_class
from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import STEP, Term, too_slow

if TYPE_CHECKING:
    from pathlib import Path

    from grader.classroom.results import Result

STUDENTS = ("anna", "bert")


def scores_of(term: Term) -> dict[str, float]:
    with term.gradebook() as gradebook:
        return {student: gradebook.find_submission(STEP, student).score for student in STUDENTS}


@pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")
def test_sync_stops_while_the_gradebook_is_locked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    for student in STUDENTS:
        folder = term.root / "class" / "submitted" / student / STEP
        shutil.copytree(term.root / "exercises" / STEP, folder)
        too_slow(folder)
    term.run("autograde", STEP)
    database = str(term.root / "class" / "gradebook.db")

    def sync() -> scores.Synced:
        return scores.sync(
            open_class(term.course), [], jobs=2, checks=None, trusted=False, say=lambda _: None, tell=lambda _: None
        )

    with closing(sqlite3.connect(database, isolation_level=None)) as other:

        def grade_and_lock(*arguments: Any) -> list[Result]:  # noqa: ANN401
            graded = grade_found(*arguments)
            other.execute("BEGIN EXCLUSIVE")
            return graded

        tries: list[str] = []
        write = scores._write

        def count_and_write(*arguments: Any) -> Any:  # noqa: ANN401
            tries.append(arguments[2].student)
            return write(*arguments)

        with monkeypatch.context() as patch:
            patch.setattr(scores, "grade_found", grade_and_lock)
            patch.setattr(scores, "_write", count_and_write)
            with pytest.raises(MachineError, match="Another program is using this database"):
                sync()
        assert len(tries) <= 1, "each further submission would wait for the lock, too"
        other.execute("ROLLBACK")
    assert scores_of(term) == dict.fromkeys(STUDENTS, 0.0), "no score is confirmed yet"
    assert not sync().unconfirmed
    assert scores_of(term) == dict.fromkeys(STUDENTS, 55.0)

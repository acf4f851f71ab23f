"""Another program locks nbgrader's database while `grader gradebook sync` is writing scores."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest

from grader.errors import MachineError
from grader.gradebook import scores
from grader.gradebook.class_folders import open_class
from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import STEP, Term, too_slow

if TYPE_CHECKING:
    from pathlib import Path

STUDENTS = ("anna", "bert")


def scores_of(term: Term) -> dict[str, float]:
    with term.gradebook() as gradebook:
        return {student: gradebook.find_submission(STEP, student).score for student in STUDENTS}


@pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")
def test_sync_stops_while_the_gradebook_is_locked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    for student in STUDENTS:
        term.submit(student, too_slow)
    term.run("autograde", STEP)
    database = str(term.root / "class" / "gradebook.db")

    def sync() -> scores.Synced:
        return scores.sync(
            open_class(term.course), [], jobs=2, checks=None, trusted=False, say=lambda _: None, tell=lambda _: None
        )

    with closing(sqlite3.connect(database, isolation_level=None)) as other:
        tries = 0
        write = scores._write

        def lock_and_write(*arguments: Any) -> Any:  # noqa: ANN401
            nonlocal tries
            tries += 1
            if tries == 1:
                other.execute("BEGIN EXCLUSIVE")
            return write(*arguments)

        with monkeypatch.context() as patch:
            patch.setattr(scores, "_write", lock_and_write)
            with pytest.raises(MachineError, match="Another program is using this database"):
                sync()
        assert tries == 1, "each further submission would wait for the lock, too"
        other.execute("ROLLBACK")
    assert scores_of(term) == dict.fromkeys(STUDENTS, 0.0), "no score is confirmed yet"
    assert not sync().unconfirmed
    assert scores_of(term) == dict.fromkeys(STUDENTS, 55.0)

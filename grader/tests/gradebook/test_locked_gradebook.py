"""While `grader gradebook sync` is writing scores, another program locks the database, or the disk becomes full."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest
from nbgrader.api import InvalidEntry
from sqlalchemy.exc import OperationalError
from tornado.log import app_log

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


def sync(term: Term) -> scores.Synced:
    return scores.sync(
        open_class(term.course), [], jobs=2, checks=None, trusted=False, say=lambda _: None, tell=lambda _: None
    )


@pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")
def test_sync_stops_while_the_gradebook_is_locked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    for student in STUDENTS:
        term.submit(student, too_slow)
    term.run("autograde", STEP)
    database = str(term.root / "class" / "gradebook.db")

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
                sync(term)
        assert tries == 1, "each further submission would wait for the lock, too"
        other.execute("ROLLBACK")
    assert scores_of(term) == dict.fromkeys(STUDENTS, 0.0), "no score is confirmed yet"
    assert not sync(term).unconfirmed
    assert scores_of(term) == dict.fromkeys(STUDENTS, 55.0)


@pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")
def test_sync_stops_if_the_disk_is_full_and_prints_no_traceback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    term = Term(tmp_path)
    term.run("generate_assignment", STEP)
    for student in STUDENTS:
        term.submit(student, too_slow)
    tries = 0
    full = OperationalError("INSERT", {}, sqlite3.OperationalError("database or disk is full"))

    def write(*_: object) -> None:
        nonlocal tries
        tries += 1
        try:
            raise full
        except OperationalError as error:  # as in nbgrader's add_submission
            app_log.exception("Rolling back session due to database error")
            raise InvalidEntry(*error.args)  # noqa: B904

    monkeypatch.setattr(scores, "_write", write)
    with pytest.raises(MachineError, match="could not be read or written: database or disk is full"):
        sync(term)
    assert tries == 1
    assert "Rolling back" not in capfd.readouterr().err

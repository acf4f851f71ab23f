"""If the disk fails, nbgrader's commands stop with one sentence, since no submission is at fault."""

from __future__ import annotations

import errno
import logging
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import pytest
from nbgrader.converters.base import NbGraderException
from nbgrader.coursedir import CourseDirectory
from nbgrader.exchange import ExchangeError
from nbgrader.utils import notebook_hash

from grader.errors import MachineError
from grader.gradebook import converters, export
from grader.gradebook.converters import BoundedAutograde, BoundedCollect, BoundedFeedback
from grader.gradebook.failed_disk import failed_disk
from grader.tests.gradebook.term import STEP, Term

if TYPE_CHECKING:
    from collections.abc import Callable

FULL = OSError(errno.ENOSPC, "No space left on device", "read", None, "/written")
COPIED = shutil.Error([("from/a", "to/a", "[Errno 28] No space left on device: 'to/a'")])


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (FULL, "The disk is full for /written: free some space there."),
        (OSError(errno.EDQUOT, "quota"), "The disk is full for /there: free some space there."),
        (OSError(errno.EROFS, "read-only", "/page"), "The disk of /page is read-only: use a folder on another disk"),
        (COPIED, "The disk is full for to/a: free some space there."),
        (OSError(errno.EACCES, "Permission denied", "/page"), ""),
        (shutil.Error([("from/a", "to/a", "[Errno 13] Permission denied: 'to/a'")]), ""),
        (ValueError("\xff"), ""),
    ],
)
def test_only_errors_of_the_disk_are_recognized(error: Exception, expected: str) -> None:
    found = failed_disk(error, Path("/there"))
    assert found.startswith(expected)
    assert bool(found) == bool(expected)
    behind = MachineError("not copied")
    behind.__cause__ = error
    assert failed_disk(behind, "/there") == found


def test_feedback_is_released_until_the_disk_is_full(tmp_path: Path) -> None:
    term = Term(tmp_path)
    pages = term.exchange / term.root.name / "feedback"
    pages.mkdir(parents=True)
    for student in ("anna", "ben", "carl"):
        folder = term.root / "class" / "feedback" / student / STEP
        folder.mkdir(parents=True)
        (folder / "timestamp.txt").write_text("2027-03-01 10:00:00 UTC")
        (folder / "submission_secret.txt").write_text(student)
        (folder / f"{STEP}.html").write_text(student)
        if student != "anna":
            (pages / f"{notebook_hash(secret=student, notebook_id=STEP)}-tmp.html").symlink_to("/dev/full")
    said = term.run("release_feedback", STEP, fails=True)
    assert said.count("The disk is full") == 1
    assert f"The disk is full for {pages}" in said
    assert "Then run the same command again." in said
    assert "was not released" not in said
    assert "student 'carl'" not in said
    assert [page.read_text() for page in pages.glob("*.html") if not page.is_symlink()] == ["anna"]


def _course(root: Path) -> CourseDirectory:
    course = CourseDirectory()
    course.root, course.assignment_id, course.db_url = str(root), STEP, f"sqlite:///{root}/gradebook.db"
    for student in ("anna", "ben"):
        for stage in ("submitted", "autograded"):
            folder = root / stage / student / STEP
            folder.mkdir(parents=True)
            (folder / f"{STEP}.ipynb").write_text("{}")
    return course


def _raising(error: Exception, tried: list[Any]) -> Callable[..., NoReturn]:
    def function(*arguments: Any, **_: Any) -> NoReturn:  # noqa: ANN401
        tried.append(arguments)
        raise error

    return function


@pytest.mark.parametrize(("kind", "method"), [
    (BoundedFeedback, "init_assignment"),
    (BoundedFeedback, "convert_single_notebook"),
    (BoundedAutograde, "init_destination"),
])  # fmt: skip
def test_the_converters_stop_at_the_first_submission(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, kind: type, method: str
) -> None:
    converter = kind(coursedir=_course(tmp_path))
    tried: list[Any] = []
    monkeypatch.setattr(kind.__mro__[2], method, _raising(FULL, tried), raising=False)
    converter.log.propagate = True
    with caplog.at_level(logging.WARNING), pytest.raises(NbGraderException, match="The disk is full for /written"):
        converter.start()
    assert len(tried) == 1
    assert [record.getMessage() for record in caplog.records] == [
        "The disk is full for /written: free some space there. Then run the same command again."
    ]
    assert not os.path.lexists(Path(converter._format_dest(STEP, "anna")) / f"{STEP}.html")


def test_feedback_whose_run_was_killed_is_made_again(tmp_path: Path) -> None:
    converter = BoundedFeedback(coursedir=_course(tmp_path))
    page = Path(converter._format_dest(STEP, "anna")) / f"{STEP}.html"
    page.parent.mkdir(parents=True)
    assert not converter.init_destination(STEP, "anna")
    (page.parent.parent / f".{STEP}.unfinished").touch()
    assert converter.init_destination(STEP, "anna")


def test_another_error_does_not_stop_the_converters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    converter = BoundedFeedback(coursedir=_course(tmp_path))
    tried: list[Any] = []
    error = OSError(errno.EACCES, "Permission denied")
    monkeypatch.setattr(converters._Feedback, "init_assignment", _raising(error, tried))
    with pytest.raises(NbGraderException, match="traceback"):
        converter.start()
    assert len(tried) == 2


def test_collecting_stops_before_another_earlier_submission_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    course = _course(tmp_path)
    collect = BoundedCollect(coursedir=course, update=True)
    inbound = tmp_path / "inbound"
    records = []
    for student in ("anna", "ben"):
        name = f"{student}+{STEP}+2027-03-01 10:00:00 UTC"
        (inbound / name).mkdir(parents=True)
        records.append(collect._path_to_record(str(inbound / name)))
    collect.src_records, collect.inbound_path = records, str(inbound)
    monkeypatch.setattr(converters, "copy_of", _raising(FULL, []))
    with pytest.raises(ExchangeError, match="The disk is full for /written"):
        collect.copy_files()
    assert (tmp_path / "submitted" / "ben" / STEP).is_dir()


def test_a_submission_that_was_collected_only_in_part_is_collected_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    collect = BoundedCollect(coursedir=_course(tmp_path / "class"))
    submission, dest = tmp_path / "inbound", tmp_path / "class/submitted/carl" / STEP
    submission.mkdir()
    (submission / "timestamp.txt").write_text("2027-03-01 10:00:00 UTC")

    def full(src: str, dst: str, **_: object) -> NoReturn:
        Path(dst).mkdir(parents=True)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), src, None, dst)

    with monkeypatch.context() as patch:
        patch.setattr(shutil, "copytree", full)
        with pytest.raises(ExchangeError, match="Then run the same command again"):
            collect.do_copy(str(submission), str(dest))
    assert list(dest.parent.iterdir()) == []
    (dest.parent / f".{STEP}.unfinished").mkdir()  # as after a run that was killed
    collect.do_copy(str(submission), str(dest))
    assert [each.name for each in dest.parent.iterdir()] == [STEP]
    assert (dest / "timestamp.txt").is_file()


def test_the_table_is_written_completely_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> NoReturn:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    table = tmp_path / "grades.csv"
    export._write(table, b"older")
    table.chmod(0o600)
    export._write(table, b"old")
    assert table.stat().st_mode & 0o777 == 0o600
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        export._write(table, b"new")
    assert [(each.name, each.read_bytes()) for each in tmp_path.iterdir()] == [("grades.csv", b"old")]
    export._write(Path(os.devnull), b"new")  # not replaced by a file
    assert not Path(os.devnull).is_file()

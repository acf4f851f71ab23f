"""A learner's files that cannot be written or read, for example because the disk is full, or they belong to root."""

from __future__ import annotations

import errno
import os
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from grader.cli import app
from grader.common.system_errors import sentence
from grader.errors import MachineError
from grader.evidence import recording_format
from grader.learner import progress, steps, workspace
from grader.tests.report.reports import report

STEP = "02-discover-topics"

pytestmark = pytest.mark.usefixtures("home")


def test_the_verdict_is_printed_before_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    root = steps.start(STEP, None).root
    graded = SimpleNamespace(report=report("failed"), evidence=None)
    monkeypatch.setattr("grader.grading.grade.grade", lambda *_, **__: graded)
    make_unwritable()
    done = CliRunner().invoke(app, ["check", str(root)])
    assert f"of {graded.report.max:g} points" in done.output
    assert isinstance(done.exception, MachineError)
    assert f"could not be written to {progress.state_file()}" in str(done.exception)


def test_the_verdict_is_printed_before_the_error_of_a_recording(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise MachineError(sentence(errno.ENOSPC))

    root = steps.start(STEP, None).root
    graded = SimpleNamespace(report=report("failed"), evidence=None, prefixes=())
    monkeypatch.setattr("grader.grading.grade.grade", lambda *_, **__: graded)
    monkeypatch.setattr(recording_format, "save", full)
    done = CliRunner().invoke(app, ["check", str(root), "--recording", str(tmp_path / "new")])
    assert f"of {graded.report.max:g} points" in done.output
    assert str(done.exception) == sentence(errno.ENOSPC)


def test_a_full_disk_leaves_no_incomplete_file_and_the_error_names_the_earlier_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def full(path: Path, mode: int) -> None:
        if path.name.strip(".").startswith("setup.py"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        chmod(path, mode)

    folder = steps.start("01", None).started.folder
    (folder / "setup.py").write_text("mine")
    chmod = Path.chmod
    with monkeypatch.context() as patch:
        patch.setattr(Path, "chmod", full)
        with pytest.raises(MachineError, match=r"No space left on device\. Your earlier work is in .*/before/"):
            steps.start("01", None, fresh=True)
    assert not list(folder.glob("*setup.py*"))
    assert "setup.py" in steps.start("01", None).started.added
    assert "setup(" in (folder / "setup.py").read_text()


def test_the_error_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    steps.start(STEP, None)
    lock = make_unwritable()
    with pytest.raises(MachineError, match="Choose a folder that you can write to: export XDG"):
        steps.start(STEP, None)
    monkeypatch.setattr(progress, "belongs_to_root", lambda path: f"{path} belongs to root.")
    with pytest.raises(MachineError, match=re.escape(f"{lock} belongs to root.")):
        steps.start(STEP, None)


def test_a_workspace_of_root_is_named_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*_: object) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), "/of/root")

    monkeypatch.setattr(workspace, "add_missing", denied)
    monkeypatch.setattr(workspace, "belongs_to_root", lambda path: f"{path} belongs to root.")
    with pytest.raises(MachineError, match=r"Permission denied. /of/root belongs to root\."):
        steps.start(STEP, None)


def test_progress_that_may_not_be_read_is_not_to_be_moved_away(monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    root = steps.start(STEP, None).root
    monkeypatch.setattr(Path, "read_text", denied)
    with pytest.raises(MachineError, match=r"\(Permission denied\)\. Choose a folder of your own: export XDG_"):
        progress.load(root)


def make_unwritable() -> Path:
    """Put a folder in the place of the lock file, so that even root cannot write the progress. Return its path."""
    lock = progress.state_file().with_suffix(".lock")
    lock.unlink()
    lock.mkdir()
    return lock

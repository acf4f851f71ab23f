"""A learner's progress that cannot be written, for example because it belongs to root."""

from __future__ import annotations

import errno
import os
import re
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest
from typer.testing import CliRunner

from grader.cli import app
from grader.errors import MachineError
from grader.learner import progress, steps, workspace
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

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


def make_unwritable() -> Path:
    """Put a folder in the place of the lock file, so that even root cannot write the progress. Return its path."""
    lock = progress.state_file().with_suffix(".lock")
    lock.unlink()
    lock.mkdir()
    return lock

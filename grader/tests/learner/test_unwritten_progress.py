"""A learner's progress that cannot be written, for example because it belongs to root."""

from __future__ import annotations

import re

import pytest
from typer.testing import CliRunner

from grader.cli import app
from grader.errors import MachineError
from grader.learner import progress, steps

STEP = "02-discover-topics"

pytestmark = pytest.mark.usefixtures("home")


def test_the_verdict_is_printed_before_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    root = steps.start(STEP, None).root
    lock = progress.state_file().with_suffix(".lock")
    lock.unlink()
    lock.mkdir()
    done = CliRunner().invoke(app, ["check", str(root)])
    assert "answers.toml can be read" in done.output
    assert isinstance(done.exception, MachineError)
    assert f"could not be written to {progress.state_file()}" in str(done.exception)
    assert str(done.exception).endswith("export XDG_STATE_HOME=FOLDER")
    monkeypatch.setattr(progress, "belongs_to_root", lambda path: f"{path} belongs to root.")
    with pytest.raises(MachineError, match=re.escape(f"{lock} belongs to root.")):
        steps.start(STEP, None)

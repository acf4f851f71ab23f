"""`grader watch` continues if the machine refuses something, or the progress cannot be read."""

from __future__ import annotations

import io
import shutil
from pathlib import Path

import pytest
from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.errors import MachineError
from grader.grading.grade import Graded
from grader.grading.options import Options
from grader.learner import progress
from grader.learner.watch import Events
from grader.learner.watch_screen import _Screen
from grader.tests.report.reports import EVIDENCE, report

ROOT = Path(__file__).resolve().parents[3]
STEP = "03-circle-publisher"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "solutions" / STEP / "my_robot_controller", tmp_path / "my_robot_controller"))


@pytest.mark.usefixtures("home")
def test_if_the_machine_refuses_something(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    graded = Graded(report("passed"), EVIDENCE["passed"], ())
    monkeypatch.setattr("grader.learner.watch.grade", lambda *_, **__: graded)
    monkeypatch.setattr("grader.learner.watch.can_be_explained", lambda _: True)
    monkeypatch.setattr("grader.learner.watch.explained", refused)
    console = Console(file=io.StringIO(), record=True, width=200)
    screen = _Screen(find_exercise(STEP), package, None, Options(in_cell=False), console)
    screen.watched.grade()
    assert screen.watched.prove(lambda _: None, lambda: False) is None
    assert not screen.watched.unproved
    monkeypatch.setattr("grader.learner.watch.open_submission", refused)
    assert screen.watched.changed()
    assert screen.show(Keys("q"), "") is None
    assert "too busy" in console.export_text()


def refused(*_: object, **__: object) -> None:
    raise MachineError("too busy")  # noqa: EM101


@pytest.mark.usefixtures("home")
def test_if_the_progress_cannot_be_read(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    graded = Graded(report("passed"), EVIDENCE["passed"], ())
    monkeypatch.setattr("grader.learner.watch.grade", lambda *_, **__: graded)
    damaged = progress.state_file()
    damaged.parent.mkdir(parents=True)
    damaged.write_text("{")
    console = Console(file=io.StringIO(), record=True, width=200)
    screen = _Screen(find_exercise(STEP), package, None, Options(in_cell=False), console)
    assert screen.show(Keys("lhq"), "") is None
    said = console.export_text()
    assert said.count("progress.json cannot be read") == 3
    assert said.index("Passed: ") < said.index("cannot be read") < said.index("Watching ")


class Keys(Events):
    """The key presses of a learner, one after the other."""

    def __init__(self, keys: str) -> None:
        super().__init__(None)
        for key in keys:
            self.press(key)

"""`grader watch` and `grader open` do not grade with a mixture of two versions of the course."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from grader.checks import exercises
from grader.checks.exercises import find_exercise
from grader.errors import MachineError, UsageError
from grader.grading.options import Options
from grader.learner import current, watch
from grader.learner.watch import Watched

ROOT = Path(__file__).resolve().parents[3]
STEP = "03-circle-publisher"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "solutions" / STEP / "my_robot_controller", tmp_path / "my_robot_controller"))


@pytest.mark.parametrize("gradings", [0, 1])
def test_an_update_before_or_during_a_grading_asks_to_start_the_command_again(
    package: Path, monkeypatch: pytest.MonkeyPatch, gradings: int
) -> None:
    begun: list[object] = []
    monkeypatch.setattr(watch, "grade", lambda *given, **_: begun.append(given))
    monkeypatch.setattr(current, "updated", lambda: len(begun) == gradings)
    with pytest.raises(MachineError, match=r"The course was updated .* and type it again"):
        Watched(find_exercise(STEP), package, Options(in_cell=False)).grade()
    assert len(begun) == gradings


def test_an_exercise_that_has_changed_must_be_loaded_again() -> None:
    exercise = find_exercise(STEP)
    current.require_current(exercise)
    with pytest.raises(MachineError, match="The course was updated"):
        current.require_current(replace(exercise, digest="0" * 64))
    with pytest.raises(MachineError, match="The course was updated"):
        current.require_current(replace(exercise, folder=exercise.folder / "removed"))


def test_an_exercise_that_only_the_new_version_can_read_is_not_called_wrong(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "exercise.toml"
    file.write_text((ROOT / "course" / STEP / "exercise.toml").read_text() + '\n[[check]]\nkind = "of_tomorrow"\n')
    with pytest.raises(UsageError, match="of_tomorrow"):
        exercises.load_exercise(file)
    monkeypatch.setattr(exercises, "updated", lambda: True)
    with pytest.raises(MachineError, match="The course was updated"):
        exercises.load_exercise(file)

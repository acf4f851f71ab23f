from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from grader.checks.exercises import find_exercise
from grader.cli import app
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder
from grader.learner import steps
from grader.learner.exercise_argument import guessed, meant


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create a workspace in which step 03 was started, and an empty current folder."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("ROS2_WORKSPACE", str(tmp_path / "ros2_ws"))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    steps.start("3", None)
    return tmp_path / "ros2_ws"


@pytest.mark.parametrize("typed", ["3", "03", "03-circle-publisher"])
def test_a_number_or_a_name_means_a_step(workspace: Path, typed: str) -> None:
    known, place = meant(Path(typed), None)
    assert (known.id, place) == ("03-circle-publisher", workspace / "src/my_robot_controller")


@pytest.mark.parametrize("typed", [None, "{}", "{}/src", "{}/src/my_robot_controller"])
def test_no_path_the_workspace_or_its_package_mean_the_current_step(workspace: Path, typed: str | None) -> None:
    path = Path(typed.format(workspace)) if typed else None
    assert meant(path, None)[0].id == "03-circle-publisher"


@pytest.mark.parametrize("exercise", ["3", "03", "03-circle-publisher"])
def test_without_a_path_each_name_of_the_current_step_means_the_workspace(workspace: Path, exercise: str) -> None:
    assert meant(None, exercise)[1] == workspace / "src/my_robot_controller"


def test_a_forgotten_slash_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS2_WORKSPACE", "~ros2_ws/second")
    with pytest.raises(UsageError, match=r"the user ros2_ws, who does not exist\. Did you mean ~/ros2_ws/second\?"):
        meant(None, None)


def test_the_folder_of_a_lesson_means_its_step(workspace: Path) -> None:
    known, place = guessed(course_folder() / "03-circle-publisher", None)
    assert known is not None
    assert (known.id, place) == ("03-circle-publisher", workspace / "src/my_robot_controller")


def test_a_folder_that_does_not_exist_is_named() -> None:
    with pytest.raises(UsageError, match="There is no folder nowhere"):
        meant(Path("nowhere"), None)


def test_an_existing_folder_with_the_name_of_a_step_is_a_folder() -> None:
    Path("03").mkdir()
    assert guessed(Path("03"), None) == (None, Path("03"))


def test_a_step_that_was_not_started_names_the_start_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS2_WORKSPACE", str(tmp_path / "another"))
    with pytest.raises(UsageError, match="`grader start 03`"):
        meant(Path("3"), None)


def test_an_unknown_exercise_lists_all_of_them() -> None:
    with pytest.raises(UsageError, match=r"01-first-node, .*, 07-challenges\b"):
        meant(Path(), None)


@pytest.mark.parametrize("typed", ["3", "03", "03-"])
def test_a_number_may_omit_the_zero(typed: str) -> None:
    assert find_exercise(typed).id == "03-circle-publisher"


def test_the_list_of_steps_is_complete() -> None:
    with pytest.raises(UsageError, match=rf"01-first-node, .*07-challenges.* and {list(catalogue())[-1]}"):
        find_exercise("99")


def test_a_check_without_a_path_or_a_step_names_the_first_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS2_WORKSPACE", str(tmp_path / "another_ws"))
    for typed in (["check"], ["check", "."]):
        done = CliRunner().invoke(app, typed)
        assert isinstance(done.exception, UsageError)
        assert str(done.exception).startswith("There is no package in ")
        assert ("type `grader start 01`" in str(done.exception)) is (typed == ["check"])


@pytest.mark.parametrize("typed", [None, "{}", "{}/src"])
def test_a_workspace_that_was_moved_names_the_two_ways_on(workspace: Path, typed: str | None) -> None:
    moved = workspace.rename(workspace.with_name("renamed"))
    path = Path(typed.format(workspace)) if typed else None
    with pytest.raises(UsageError, match=r"my_robot_controller, no longer exists\..*`grader start 03`\.$"):
        guessed(path, None)
    assert guessed(None, None, moved) == (None, Path()), "progress belongs to the path of the workspace"
    steps.start("3", moved)
    assert guessed(None, None, moved)[1] == moved / "src/my_robot_controller"


@pytest.mark.parametrize("typed", [None, "{}/src", "03"])
def test_a_package_whose_folder_was_renamed_names_the_command_that_renames_it_back(
    workspace: Path, typed: str | None
) -> None:
    package = workspace / "src/my_robot_controller"
    renamed = package.rename(package.with_name("my robot"))
    with pytest.raises(UsageError) as caught:
        guessed(Path(typed.format(workspace)) if typed else None, None)
    (command,) = re.findall(r"`(mv [^`]*)`", str(caught.value))
    subprocess.run(command, shell=True, check=True)
    assert not renamed.exists()
    assert guessed(Path(typed.format(workspace)) if typed else None, None)[1] == package


def test_of_two_other_packages_none_is_taken_for_the_renamed_one(workspace: Path) -> None:
    package = workspace / "src/my_robot_controller"
    shutil.copytree(package, package.with_name("one"))
    package.rename(package.with_name("two"))
    with pytest.raises(UsageError) as caught:
        guessed(None, None)
    assert "mv " not in str(caught.value)


def test_who_has_started_a_step_is_not_sent_to_the_first_one(workspace: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere/package.xml").touch()
    with pytest.raises(UsageError) as caught:
        meant(Path(), None)
    assert "grader start 01" not in str(caught.value)
    assert f"your current step, 03-circle-publisher, in {workspace}/src/my_robot_controller." in str(caught.value)

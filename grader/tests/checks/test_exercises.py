from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from grader.checks.exercises import exercise_of_folder, find_exercise, title_of
from grader.errors import UsageError
from grader.exercise.model import catalogue, course_folder


def test_an_exercise_is_found_by_its_id_or_its_beginning() -> None:
    assert find_exercise("03-circle-publisher") == find_exercise("03")


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("03-circle-publsher", "Did you mean 03-circle-publisher?"),
        ("O1", "there is no exercise 'O1'. Did you mean 01-first-node? The exercises are"),
        ("first", "Did you mean 01-first-node?"),
        ("99", "there is no exercise '99'"),
        pytest.param("9" * 5000, "there is no exercise '999", id="more digits than int() reads"),
        ("", "there is no exercise ''"),
    ],
)
def test_an_unknown_exercise_names_those_that_there_are(name: str, hint: str) -> None:
    with pytest.raises(UsageError) as raised:
        find_exercise(name)
    assert hint in str(raised.value)
    assert "03-circle-publisher" in str(raised.value)


def test_several_exercises_that_begin_alike_are_named(tmp_path: Path) -> None:
    for name in ("03-a", "03-b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "exercise.toml").touch()
    with pytest.raises(UsageError, match=r"several exercises start with '03'.*03-a and 03-b"):
        find_exercise("03", tmp_path)
    with pytest.raises(UsageError, match="there is no exercise '04'") as raised:
        find_exercise("04", tmp_path)
    assert "several exercises start with" not in str(raised.value)


@pytest.mark.parametrize(("names", "end"), [((), "The course has no exercises."), (("03-a",), "The exercise is 03-a.")])
def test_a_course_with_few_exercises_is_told(names: tuple[str, ...], end: str, tmp_path: Path) -> None:
    for name in names:
        (tmp_path / name).mkdir()
        (tmp_path / name / "exercise.toml").touch()
    with pytest.raises(UsageError, match=f"there is no exercise '04'. {end}$"):
        find_exercise("04", tmp_path)


def test_the_exercise_follows_from_a_folder_below_solutions_and_exercises() -> None:
    root = course_folder().parent
    inside = root / "solutions" / "03-circle-publisher" / "my_robot_controller"
    found = exercise_of_folder(inside)
    assert found is not None
    assert found.id == "03-circle-publisher"
    assert exercise_of_folder(root / "exercises" / "03-circle-publisher") == found
    assert exercise_of_folder(root / "grader") is None
    assert exercise_of_folder(Path("/tmp/03-circle-publisher")) is None


@pytest.mark.parametrize("name", catalogue())
def test_an_outline_is_the_exercise_without_the_parameters_of_its_checks(name: str) -> None:
    whole = find_exercise(name)
    outline = find_exercise(name, outline=True)
    assert outline == replace(whole, checks=tuple(replace(check, params={}) for check in whole.checks))


def test_a_hint_imports_no_kind(tmp_path: Path) -> None:
    command = [sys.executable, "-P", "-X", "importtime", "-c", "from grader.cli import main; main()", "hint", "03"]
    environment = {**os.environ, "HOME": str(tmp_path), "XDG_STATE_HOME": str(tmp_path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("Hint 1 of")
    assert "grader.checks.kinds" in done.stderr
    assert "grader.checks.subjects" not in done.stderr


def test_the_title_is_read_without_the_checks() -> None:
    assert {name: title_of(file) for name, file in catalogue().items()} == {
        name: find_exercise(name).title for name in catalogue()
    }


@pytest.mark.parametrize(
    ("text", "named"), [('schema = 2\n\n[exercise]\nid = "01-x"\n\n[[check]]\n', "title"), ("exercise = 1\n", "schema")]
)
def test_the_title_of_an_exercise_with_a_mistake_is_refused_as_the_exercise_is(
    text: str, named: str, tmp_path: Path
) -> None:
    file = tmp_path / "exercise.toml"
    file.write_text(text)
    with pytest.raises(UsageError, match=named):
        title_of(file)


def test_an_id_that_is_not_the_name_of_the_folder_is_an_error(tmp_path: Path) -> None:
    text = (course_folder() / "01-first-node/exercise.toml").read_text("utf-8")
    (tmp_path / "14-new").mkdir()
    (tmp_path / "14-new/exercise.toml").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=r'the id is "01-first-node", but it must be the name of the folder, "14-new"'):
        find_exercise("14", tmp_path)

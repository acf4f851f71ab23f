"""The repository for students contains everything that a student needs, but no solutions and no tests."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.authoring.handout import hand_out
from grader.authoring.release import released
from grader.errors import UsageError
from grader.exercise.model import catalogue

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def students(tmp_path_factory: pytest.TempPathFactory) -> Path:
    to = tmp_path_factory.mktemp("handout") / "for-students"
    hand_out(to)
    return to


def test_students_get_lessons_starting_points_and_the_grader(students: Path) -> None:
    for name in catalogue():
        assert (students / "course" / name / "lesson.md").is_file()
        assert (students / "course" / name / "exercise.toml").is_file()
        given = {str(path.relative_to(students / "exercises" / name)) for path in files(students / "exercises" / name)}
        assert given == set(released(ROOT / "solutions" / name))
        assert f"course/{name}/lesson.md" in (students / "README.md").read_text()
    files_of_the_top = ("Makefile", "pyproject.toml", "requirements.lock", "LICENSE", "COLCON_IGNORE")
    for name in (
        *files_of_the_top,
        "grader/cli.py",
        "grader/setup/bootstrap.py",
        "docs/learner.md",
        "docs/security.md",
    ):
        assert (students / name).is_file()


def test_students_get_no_solution_and_no_test(students: Path) -> None:
    assert [path for path in files(students) if {"solutions", "tests"} & set(path.relative_to(students).parts)] == []
    solved = (ROOT / "solutions/07-challenges/my_robot_controller/my_robot_controller/go_to_goal.py").read_text()
    line = next(line for line in solved.splitlines() if "atan2(dy, dx)" in line)
    assert [path for path in files(students) if path.suffix == ".py" and line in path.read_text("utf-8")] == []


def test_a_folder_that_is_not_empty_stays_unchanged(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("")
    with pytest.raises(UsageError, match="is not an empty folder"):
        hand_out(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_a_copy_without_solutions_cannot_make_the_repository(
    students: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grader.authoring.handout.course_folder", lambda: students / "course")
    with pytest.raises(UsageError, match="does not have this folder"):
        hand_out(tmp_path / "again")
    assert not (tmp_path / "again").exists()


def files(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]

"""The repository for students contains everything that a student needs, but no solutions and no tests."""

from __future__ import annotations

import re
import subprocess
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
        "docs/sandbox.md",
    ):
        assert (students / name).is_file()


def test_students_get_no_solution_and_no_test(students: Path) -> None:
    assert [path for path in files(students) if {"solutions", "tests"} & set(path.relative_to(students).parts)] == []
    solved = (ROOT / "solutions/07-challenges/my_robot_controller/my_robot_controller/go_to_goal.py").read_text()
    line = next(line for line in solved.splitlines() if "atan2(dy, dx)" in line)
    assert [path for path in files(students) if path.suffix == ".py" and line in path.read_text("utf-8")] == []


def test_no_page_for_students_tells_an_instructor_what_to_do(students: Path) -> None:
    pages = sorted(path.relative_to(students).as_posix() for path in students.glob("docs/*"))
    names = ("commands", "glossary", "kinds", "learner", "ros2-differences", "sandbox", "security")
    assert pages == [f"docs/{name}.md" for name in names]
    for page in (*pages, "README.md", "Makefile", *(f"course/{name}/lesson.md" for name in catalogue())):
        text = (students / page).read_text("utf-8")
        assert re.findall(r".*(?:solutions/|a correct solution|grade a class).*", text) == [], page
    assert not (students / "course" / "nbgrader_config.py").exists()


def test_the_makefile_has_only_targets_that_work_without_tests(students: Path) -> None:
    targets = re.findall(r"^([a-z0-9.-]+):", (students / "Makefile").read_text("utf-8"), re.MULTILINE)
    assert targets == ["help", "demo", "notebooks", "clean", "python3"]


def test_every_link_on_a_page_for_students_leads_somewhere(students: Path) -> None:
    for page in (students / "README.md", *students.glob("docs/*.md"), *students.glob("course/*/*.md")):
        links = re.findall(
            r"\]\(([^)\s]+)\)",
            re.sub(r"^```.*?^```|`[^`\n]*`", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL),
        )
        files_of_links = [link.partition("#")[0] for link in links if not link.startswith(("https://", "#"))]
        assert [link for link in files_of_links if not (page.parent / link).exists()] == [], page


def test_the_makefile_for_students_has_only_their_targets(students: Path) -> None:
    done = subprocess.run(
        ["make", "--no-print-directory", "help"], cwd=students, capture_output=True, text=True, check=True
    )
    assert [line.split()[1] for line in done.stdout.splitlines()] == ["help", "demo", "notebooks", "clean"]
    done = subprocess.run(["make", "-n", "demo", "notebooks"], cwd=students, capture_output=True, text=True, check=True)
    assert "grader.setup.demo" in done.stdout


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

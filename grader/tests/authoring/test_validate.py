"""The course and the example in docs/authors.md are valid, and problems of an exercise are reported."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from grader.authoring.console_blocks import blocks
from grader.authoring.release import main as release
from grader.authoring.validate import _Validation, lesson_problems, validate
from grader.cli import app
from grader.errors import UsageError
from grader.tests.case import copy_solution

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parent.parent.parent.parent
NEW = "14-straight-on"
NODE = "my_robot_controller/straight_on.py"
TASK = """\
        # BEGIN SOLUTION
        msg.linear.x = 0.5
        # END SOLUTION
        # BEGIN STARTER
        # # TODO: make it drive.
        # END STARTER
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Create a course that contains only the exercise in docs/authors.md."""
    text = (ROOT / "docs/authors.md").read_text("utf-8")
    exercise = next(block.text for block in blocks(text) if block.language == "toml")
    (tmp_path / "course" / NEW).mkdir(parents=True)
    (tmp_path / "course" / NEW / "exercise.toml").write_text(exercise)
    (tmp_path / "course" / NEW / "lesson.md").write_text("# Straight on\n\n" + "word " * 1200 + "\n")
    package = tmp_path / "solutions" / NEW / "my_robot_controller"
    copy_solution("03-circle-publisher", package)
    node = (package / "my_robot_controller/draw_circle.py").read_text().replace("draw_circle", "straight_on")
    driving = "        msg.linear.x = 2.0\n        msg.angular.z = 1.0\n"
    assert driving in node
    (package / NODE).write_text(node.replace(driving, TASK))
    setup = (package / "setup.py").read_text()
    (package / "setup.py").write_text(setup.replace("draw_circle", "straight_on"))
    shown = (ROOT / "solutions/03-circle-publisher/03-circle-publisher.ipynb").read_text("utf-8")
    (tmp_path / "solutions" / NEW / f"{NEW}.ipynb").write_text(shown.replace("draw_circle.py", "straight_on.py"))
    (tmp_path / "exercises").mkdir()
    return tmp_path


def problems(root: Path) -> list[str]:
    assert release(["--root", str(root)]) == 0
    return validate([], app, course=root / "course")


def change(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


@pytest.mark.exhaustive
def test_the_course_is_valid() -> None:
    assert validate([], app) == []


def test_the_course_is_valid_apart_from_its_solutions(monkeypatch: pytest.MonkeyPatch) -> None:
    """The solutions are not graded here, because the test of the lessons grades them."""
    graded = _Validation._graded

    def only_starting_points(self: _Validation, what: str, side: str) -> Any:  # noqa: ANN401 - a Report, or its part
        return SimpleNamespace(outcomes=()) if what == "solution" else graded(self, what, side)

    monkeypatch.setattr(_Validation, "_graded", only_starting_points)
    assert validate([], app) == []


def test_each_lesson_shows_that_its_solution_passes() -> None:
    for lesson in (ROOT / "course").glob("*/lesson.md"):
        solved = [block.text for block in blocks(lesson.read_text("utf-8")) if block.about == "solved"]
        assert any("$ grader check\n" in text and "Passed: 100 of 100 points." in text for text in solved), lesson


def test_a_new_exercise_is_one_folder_per_side_without_python(root: Path) -> None:
    assert problems(root) == []
    assert "TODO: make it drive." in (root / "exercises" / NEW / "my_robot_controller" / NODE).read_text()


def test_a_copied_notebook_gets_the_id_of_its_step(root: Path) -> None:
    assert release(["--root", str(root)]) == 0
    for side in ("solutions", "exercises"):
        text = (root / side / NEW / f"{NEW}.ipynb").read_text("utf-8")
        assert f'"%step {NEW}"' in text
        assert f'"check(\\"{NEW}\\")"' in text
        assert 'check(\\"03-circle-publisher\\")' not in text


def test_a_step_needs_a_notebook_of_its_own(root: Path) -> None:
    """nbgrader's generate_assignment would stop with an error."""
    folder = root / "solutions" / NEW
    (folder / f"{NEW}.ipynb").rename(folder / "another-name.ipynb")
    (problem,) = problems(root)
    assert problem.startswith(f"{folder}/{NEW}.ipynb is missing: every step has a notebook.")


def test_a_wrong_command_in_a_lesson_is_a_problem(root: Path) -> None:
    lesson = root / "course" / NEW / "lesson.md"
    lesson.write_text(f"{lesson.read_text()}\n```console\n$ grader start 15\n$ grader start 14\n```\n")
    reported = f"{lesson}: `grader start 15` is not a valid command: the course has no step 15."
    assert problems(root) == [reported]


def test_the_id_must_be_the_name_of_the_folder(root: Path) -> None:
    file = root / "course" / NEW / "exercise.toml"
    change(file, f'id = "{NEW}"', 'id = "14-straight"')
    assert f'{file}: [exercise]: "id" is "14-straight"; it must be "{NEW}", the name of the folder.' in problems(root)


def wrong_solution(root: Path) -> None:
    change(root / "solutions" / NEW / "my_robot_controller" / NODE, "0.5", "0.6")


def solved_starting_point(root: Path) -> None:
    change(root / "solutions" / NEW / "my_robot_controller" / NODE, "# # TODO: make it drive.", "# msg.linear.x = 0.5")


def other_fault_at_the_start(root: Path) -> None:
    change(root / "course" / NEW / "exercise.toml", '["values"]', '["start"]')


def test_a_check_that_the_starting_point_fails_needs_a_hint(root: Path) -> None:
    change(root / "course" / NEW / "exercise.toml", "[[hint]]", '[[hint]]\nchecks = ["start"]')
    reported = f"{root}/course/{NEW}/exercise.toml: the starting point fails values, but no [[hint]] lists this check."
    assert problems(root) == [reported]


@pytest.mark.parametrize(
    ("spoil", "reported"),
    [
        (wrong_solution, f"solutions/{NEW} does not pass: The turtle drives straight on at 0.5 m/s: failed."),
        (solved_starting_point, f"exercises/{NEW} should fail the check 'values' but does not."),
        (other_fault_at_the_start, f"exercises/{NEW} fails for an unintended reason: "),
    ],
)
def test_unexpected_results_of_gradings_are_reported(root: Path, spoil: Callable[[Path], None], reported: str) -> None:
    spoil(root)
    assert any(problem.startswith(reported) for problem in problems(root))


def test_a_starting_point_that_fails_nothing_is_reported(root: Path) -> None:
    solved_starting_point(root)
    change(root / "course" / NEW / "exercise.toml", 'starting_point_fails = ["values"]', "")
    reported = f"exercises/{NEW} fails no check. A starting point must fail at least one check."
    assert problems(root) == [reported]


def test_an_executable_that_the_solution_does_not_have_is_reported(root: Path) -> None:
    lesson = root / "course" / NEW / "lesson.md"
    good = lesson.read_text()
    lesson.write_text(good + "\n```console\n$ ros2 run my_robot_controller straight_on\n```\n")
    assert list(lesson_problems(lesson, app)) == []
    lesson.write_text(good + "\n```console\n$ ros2 run my_robot_controller draw_circle\n```\n")
    (problem,) = lesson_problems(lesson, app)
    assert problem.endswith("is not a valid command: the package my_robot_controller has no executable 'draw_circle'.")


def test_a_lesson_of_one_word_has_1_word(tmp_path: Path) -> None:
    (tmp_path / "lesson.md").write_text("Short.\n")
    (problem,) = lesson_problems(tmp_path / "lesson.md", app)
    assert "has 1 word (without code)" in problem


def test_a_lesson_that_is_not_utf8_is_a_problem(tmp_path: Path) -> None:
    (tmp_path / "lesson.md").write_bytes(b"# A\n\ncaf\xe9\n")
    (problem,) = lesson_problems(tmp_path / "lesson.md", app)
    assert problem == f"{tmp_path}/lesson.md, line 3: this is not UTF-8. Save the file as UTF-8."


def test_all_missing_things_are_reported_together(root: Path) -> None:
    course = root / "course" / NEW
    (course / "lesson.md").write_text("Too short, with a [link](nowhere.md).\n")
    change(course / "exercise.toml", "[[hint]]", "[[trial]]")
    assert validate([], app, course=root / "course")[1:] == validate([NEW], app, course=root / "course")[1:]
    change(course / "exercise.toml", '[[trial]]\ntext = "Two', '# "Two')
    shutil.rmtree(root / "solutions" / NEW)
    reported = "\n".join(validate([], app, course=root / "course"))
    for problem in ("the file has no [[hint]]", "words (without code)", "links to nowhere.md", f"solutions/{NEW}"):
        assert problem in reported


def test_an_unknown_exercise_is_an_error_that_lists_all(root: Path) -> None:
    with pytest.raises(UsageError, match=f"The course has no exercise 09-x. The exercises are {NEW}."):
        validate(["09-x"], app, course=root / "course")

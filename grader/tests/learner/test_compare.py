"""The learner's files next to the solution, and the answers to a lesson's questions."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.errors import UsageError
from grader.exercise.model import course_folder
from grader.learner import progress, steps
from grader.learner.compare import OTHER_NUMBERS, print_solution
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.usefixtures("home")
FIRST = "01-first-node"


def passed(name: str) -> None:
    root = progress.workspace_of(None)
    progress.update(root, lambda before: before.graded(name, report("passed")))


def test_the_solution_shows_only_files_that_the_learner_had_to_write(home: Path) -> None:
    steps.start("01", None)
    said = Console(width=100, record=True, file=io.StringIO())
    with pytest.raises(UsageError, match="after your own solution has passed"):
        print_solution("01", None, said)
    passed(FIRST)
    (home / "ros2_ws/src/my_robot_controller/package.xml").write_text("grown in later steps")
    print_solution("01", None, said)
    text = said.export_text()
    assert '+            "test_node = my_robot_controller.my_first_node:main",' in text
    assert "-            # TODO 5" in text
    assert "package.xml" not in text
    assert "BEGIN SOLUTION" not in text
    assert "Afterwards: answers to" in text


def test_a_comment_of_the_learner_is_never_a_marker(home: Path) -> None:
    steps.start("01", None)
    passed(FIRST)
    node = home / "ros2_ws/src/my_robot_controller/my_robot_controller/my_first_node.py"
    node.write_text(f"# begin starter code\n{node.read_text('utf-8')}", "utf-8")
    said = Console(width=100, record=True, file=io.StringIO())
    print_solution("01", None, said)
    assert "-# begin starter code" in said.export_text()


def test_a_folder_that_was_deleted_is_named() -> None:
    passed(FIRST)
    with pytest.raises(UsageError, match=r"There is no folder .*my_robot_controller\. `grader start 01` creates it\."):
        print_solution("01", None, Console(file=io.StringIO()))


def test_the_solution_does_not_show_the_nodes_of_earlier_steps() -> None:
    steps.start("12", None)
    passed("12-tests")
    said = Console(width=100, record=True, file=io.StringIO())
    print_solution("12", None, said)
    text = said.export_text()
    assert "test/test_wall_guard.py" in text
    assert "wall_guard.py" in text
    assert [name for name in ("two_pens", "tunable_circle", "draw_star", "circle_fit") if f"{name}.py" in text] == []


@pytest.mark.parametrize(("step", "tells"), [("10", True), ("01", False)])
def test_the_solution_says_that_its_numbers_are_not_the_learners(step: str, *, tells: bool) -> None:
    steps.start(step, None)
    passed(find_exercise(step).id)
    said = Console(width=100, record=True, file=io.StringIO())
    print_solution(step, None, said)
    assert (OTHER_NUMBERS in said.export_text()) == tells


@pytest.mark.parametrize("name", [file.parent.name for file in course_folder().glob("*/afterwards.md")])
def test_each_question_of_a_lesson_has_an_answer(name: str) -> None:
    folder = find_exercise(name).folder
    questions = (folder / "lesson.md").read_text("utf-8").partition("## To think about")[2].partition("\n---")[0]
    numbers = re.compile(r"^(\d+)\. ", re.MULTILINE)
    answers = (folder / "afterwards.md").read_text("utf-8")
    assert numbers.findall(questions) == numbers.findall(answers) != []

"""What the page asks a learner to add to the package files."""

from __future__ import annotations

from grader.checks.exercises import find_exercise
from grader.exercise.model import course_folder
from grader.open.grading import lacking


def test_a_package_that_grew_gets_the_tasks_of_the_step() -> None:
    before = course_folder().parent / "solutions/07-challenges/my_robot_controller"
    files = {name: (before / name).read_bytes() for name in ("package.xml", "setup.py")}
    texts = [each["text"] for each in lacking(find_exercise("08-services"), files)]
    assert texts == [
        "To do in package.xml: TODO 2: which package has the type SetBool?",
        "To do in setup.py: TODO 1: add the entry points two_pens and pausable_circle.",
    ]

"""A class with the notebooks of steps 10 to 13: released, handed in with a solution and with a mistake, graded."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.sandbox import bubblewrap
from grader.tests.gradebook.term import Term
from grader.tests.learner.story import solve_in

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="autograde runs submissions only in a sandbox")

MISTAKES = {
    "10-actions": ("my_robot_controller/lookout.py", "self.goal.cancel_goal_async()", "pass", "/stop"),
    "11-bags": ("answers.toml", "62.5 Hz", "6.25 Hz", "6.25"),
    "12-tests": ("test/test_wall_guard.py", "== pytest.approx(TURN)", "!= 0.0", "turns right instead of left"),
    "13-catch-them-all": ("my_robot_controller/spawner.py", "self.left.remove(request.name)", "pass", "/targets"),
}
"""For each step: a file of the solution, a string in it, what the mistake puts there, and a string of the feedback."""


def hand_in(term: Term, student: str, mistake: tuple[str, str, str] | None) -> None:
    exercise = find_exercise(term.step)

    def change(folder: Path) -> None:
        package = folder / "my_robot_controller"
        assert exercise.numbers is not None
        (package / exercise.numbers.file).write_text(to_toml(draw_numbers(exercise.numbers, student)))
        solve_in(package, exercise)
        if mistake is not None:
            file, old, new = mistake
            text = (package / file).read_text()
            assert old in text
            (package / file).write_text(text.replace(old, new))

    term.hand_in(student, change)


@pytest.mark.exhaustive
@pytest.mark.parametrize("step", MISTAKES)
def test_a_class_of_a_step_of_part_two(step: str, tmp_path: Path) -> None:
    *mistake, reason = MISTAKES[step]
    file, old, new = mistake
    term = Term(tmp_path, step)
    term.generate()
    hand_in(term, "ada", None)
    hand_in(term, "ben", (file, old, new))
    term.grade()
    exported = term.exported()
    assert exported["ada"] == (100, 0, 100)
    assert 0 < exported["ben"][0] < 100
    assert reason in term.feedback("ben")

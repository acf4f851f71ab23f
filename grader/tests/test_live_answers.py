"""The correct answers of step 02 come from a running simulator: with another simulator, other answers are correct."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import load_exercise
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.sandbox import bubblewrap
from grader.submission.package import open_answers
from grader.tests.case import copy_solution

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.report.report import Report

ROOT = Path(__file__).parent.parent.parent
STEP = "02-discover-topics"
SCENARIO = "[[trial]]\n"


@pytest.fixture
def judged(tmp_path: Path) -> Callable[[str, dict[str, str]], Report]:
    def judge(scenario: str, answers: dict[str, str]) -> Report:
        """Grade the solution, in which some answers have been changed, in a scenario with additional lines.

        Return the report.
        """
        shutil.copytree(ROOT / "course" / STEP, tmp_path / STEP)
        file = tmp_path / STEP / "exercise.toml"
        file.write_text(file.read_text().replace(SCENARIO, SCENARIO + scenario))
        copy_solution(STEP, tmp_path / "given")
        given = tmp_path / "given" / "answers.toml"
        text = given.read_text()
        for old, new in answers.items():
            assert old in text
            text = text.replace(old, new)
        given.write_text(text)
        return grade(load_exercise(file), open_answers(tmp_path / "given"), Options(in_cell=bubblewrap.usable())).report

    return judge


def not_passed(report: Report) -> set[str]:
    return {outcome.id for outcome in report.outcomes if outcome.status.value != "passed"}


def test_the_solution_is_right_about_turtlesim(judged: Callable[[str, dict[str, str]], Report]) -> None:
    assert not_passed(judged("", {})) == set()


def test_a_renamed_topic_and_a_slower_pose_make_the_same_answers_wrong(
    judged: Callable[[str, dict[str, str]], Report],
) -> None:
    changed = 'rename = ["/turtle1/cmd_vel:=/turtle1/drive"]\npose_every = 5\n'
    assert not_passed(judged(changed, {})) == {"motion-topic", "pose-rate"}


def test_a_renamed_topic_and_a_slower_pose_make_other_answers_right(
    judged: Callable[[str, dict[str, str]], Report],
) -> None:
    changed = 'rename = ["/turtle1/cmd_vel:=/turtle1/drive"]\npose_every = 5\n'
    assert not_passed(judged(changed, {"/turtle1/cmd_vel": "/turtle1/drive", "62.5": "12.5"})) == set()

"""The commands that are named after a step has been started or has passed."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.errors import MachineError, UsageError
from grader.learner import progress, steps, workspace
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

FIRST, SECOND = "01-first-node", "02-discover-topics"

pytestmark = pytest.mark.usefixtures("home")


def test_the_next_step_is_named_only_if_the_current_step_has_passed() -> None:
    own = steps.start(FIRST, None).started.folder
    steps.start(SECOND, None)
    said = steps.note(find_exercise(FIRST), own, report("passed"))
    assert f"Your current step, {SECOND}, has not passed yet." in said
    assert "start next" not in said
    progress.update(progress.workspace_of(None), lambda before: before.graded(SECOND, report("passed")))
    assert "The next step: grader start next" in steps.note(find_exercise(FIRST), own, report("passed"))


def test_the_command_for_the_solution_is_named_only_if_there_is_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = steps.start(FIRST, None).started.folder
    assert "grader solution 01" in steps.note(find_exercise(FIRST), own, report("passed"))
    monkeypatch.setattr(workspace, "course_folder", lambda: tmp_path / "course")
    assert "solution" not in steps.note(find_exercise(FIRST), own, report("passed"))


@pytest.mark.parametrize(("current", "another"), [("04", "05"), ("13", "01")])
def test_a_step_that_has_not_passed_can_be_skipped_for_another_one(current: str, another: str) -> None:
    steps.start(current, None)
    with pytest.raises(UsageError, match=f"To skip this step for now, .*`grader start {another}`"):
        steps.start("next", None)


def test_a_current_step_that_the_course_no_longer_has_does_not_stop_the_learner() -> None:
    own = steps.start(FIRST, None).started.folder
    progress.update(
        progress.workspace_of(None), lambda before: before.graded("00-gone", report("passed")).at("00-gone")
    )
    assert "The next step: grader start next" in steps.note(find_exercise(FIRST), own, report("passed"))
    said = Console(width=100, record=True, file=io.StringIO())
    steps.print_status(None, said)
    assert "Continue with: grader start next" in said.export_text()


def test_a_progress_file_that_cannot_be_read_is_named_once() -> None:
    progress.state_file().mkdir(parents=True)
    with pytest.raises(MachineError) as refused:
        progress.load(progress.workspace_of(None))
    assert str(refused.value).startswith(f"Your progress in {progress.state_file()} cannot be read (Is a directory). ")


def test_another_workspace_needs_a_variable_for_the_next_commands(home: Path) -> None:
    command = f"export ROS2_WORKSPACE={home / 'other_ws'}"
    assert command in steps.begin_message(steps.start("01", home / "other_ws"))
    assert "ROS2_WORKSPACE" not in steps.begin_message(steps.start("01", None))

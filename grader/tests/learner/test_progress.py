from __future__ import annotations

import io
import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.errors import MachineError, UsageError
from grader.exercise.model import catalogue, course_folder
from grader.exercise.own_numbers import draw_numbers, from_toml
from grader.learner import progress, steps, workspace
from grader.learner.progress import Progress, StepProgress
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

FIRST, SECOND = "01-first-node", "02-discover-topics"


pytestmark = pytest.mark.usefixtures("home")


def passed(name: str) -> None:
    root = progress.workspace_of(None)
    progress.update(root, lambda before: before.graded(name, report("passed")))


def test_each_workspace_has_its_own_progress(home: Path) -> None:
    progress.update(home / "one", lambda before: before.at(FIRST))
    progress.update(home / "two", lambda before: before.at(SECOND))
    assert progress.load(home / "one").current == FIRST
    assert progress.load(home / "two").current == SECOND
    assert progress.load(home / "three").current is None


def test_a_student_keeps_the_id_that_was_drawn_once(home: Path) -> None:
    drawn = progress.update(home, lambda before: before.at(FIRST)).student
    assert drawn
    assert progress.update(home, lambda before: before.at(SECOND)).student == drawn


def test_points_never_go_down_and_what_has_passed_stays_passed() -> None:
    right, wrong = report("passed"), report("failed")
    assert (right.exit_code, wrong.exit_code) == (0, 1)
    step = Progress("x").graded(FIRST, right).graded(FIRST, wrong).step(FIRST)
    assert (step.points, step.max, step.passed) == (right.points, right.max, True)
    assert step.failed == tuple(outcome.id for outcome in wrong.outcomes if outcome.status is Status.FAILED)


def test_hints_that_an_older_version_counted_were_read(home: Path) -> None:
    progress.update(home, lambda before: before.at(FIRST))
    file = progress.state_file()
    data = json.loads(file.read_text())
    data["workspaces"][str(home)]["steps"][FIRST] = {"points": 1.0, "max": 2.0, "passed": False, "hints": 2}
    file.write_text(json.dumps(data))
    assert progress.load(home).step(FIRST) == StepProgress(1.0, 2.0, read=(0, 1))


def test_forty_writers_at_once_lose_no_change(home: Path) -> None:
    def one_hint(before: Progress) -> Progress:
        known = before.step(FIRST)
        return before.with_step(FIRST, replace(known, read=(*known.read, len(known.read))))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: progress.update(home, one_hint), range(40)))
    assert progress.load(home).step(FIRST).read == tuple(range(40))


@pytest.mark.parametrize("content", ["{", "[]", '{"schema": 99}', ""])
def test_a_damaged_file_is_an_error_and_stays_unchanged(home: Path, content: str) -> None:
    file = progress.state_file()
    file.parent.mkdir(parents=True)
    file.write_text(content)
    with pytest.raises(MachineError, match=r"progress\.json"):
        progress.update(home, lambda before: before.at(FIRST))
    assert file.read_text() == content


def test_start_adds_missing_files_and_overwrites_nothing(home: Path) -> None:
    begun = steps.start("01", None)
    package = home / "ros2_ws/src/my_robot_controller"
    assert begun.started.folder == package
    assert "package.xml" in begun.started.added
    (package / "setup.py").write_text("mine")
    (package / "package.xml").unlink()
    again = steps.start("01", None)
    assert again.started.added == ("package.xml",)
    assert "setup.py" in again.started.present
    assert (package / "setup.py").read_text() == "mine"


def test_a_step_alone_names_the_files_of_earlier_steps_with_their_tasks() -> None:
    begun = steps.start("13", None)
    modules = {path.rpartition("/")[2] for path in begun.started.earlier}
    assert {"two_pens.py", "own_circle.py", "wall_guard.py"} <= modules
    assert not {"spawner.py", "catcher.py", "setup.py", "__init__.py"} & modules
    first, second = steps.begin_message(begun).splitlines()[1:3]
    assert "spawner.py" in first
    assert "two_pens.py" not in first
    assert second.startswith("Also added, from earlier steps: ")
    assert second.endswith("The tasks (TODO) in these files are not part of this step.")
    one = replace(begun, started=replace(begun.started, earlier=("two_pens.py",)))
    assert "The tasks (TODO) in this file are not part of this step." in steps.begin_message(one)


def test_a_workspace_that_has_the_earlier_steps_gets_no_file_of_them() -> None:
    for step in ("07", "08", "09"):
        begun = steps.start(step, None)
    assert begun.started.earlier == ()
    assert [path for path in begun.started.added if path.endswith(".py")] == ["my_robot_controller/tunable_circle.py"]


def test_start_quotes_the_path_that_a_new_terminal_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.prefix", "/home/ada/my course/.venv")
    monkeypatch.setenv("SHELL", "/bin/bash")
    said = steps.begin_message(steps.start("01", None))
    assert said.endswith("In each new terminal: source '/home/ada/my course/.venv/setup.bash'")
    monkeypatch.setenv("SHELL", "/usr/bin/fish")  # which cannot read the file
    assert steps.begin_message(steps.start("01", None)).splitlines()[-2:] == [
        "In each new terminal: bash",
        "In this bash:         source '/home/ada/my course/.venv/setup.bash'",
    ]


def test_fresh_moves_the_old_work_to_a_folder_that_colcon_ignores(home: Path) -> None:
    steps.start("01", None)
    package = home / "ros2_ws/src/my_robot_controller"
    (package / "setup.py").write_text("mine")
    begun = steps.start("01", None, fresh=True)
    assert begun.started.kept is not None
    assert (begun.started.kept / "setup.py").read_text() == "mine"
    assert (begun.started.kept.parent / "COLCON_IGNORE").exists()
    assert (package / "setup.py").read_text() != "mine"


def test_next_waits_until_the_step_has_passed(home: Path) -> None:
    assert steps.start("next", None).exercise.id == FIRST
    with pytest.raises(UsageError, match="You have not passed"):
        steps.start("next", None)
    passed(FIRST)
    assert steps.start("next", None).exercise.id == SECOND
    assert json.loads(progress.state_file().read_text())["workspaces"][str(home / "ros2_ws")]["current"] == SECOND


def test_there_is_no_next_step_after_the_last_one() -> None:
    *others, last = catalogue()
    steps.start(last, None)
    passed(last)
    with pytest.raises(UsageError, match=r"Not passed yet: 01, 02.* Go on with `grader start 01`"):
        steps.start("next", None)
    for name in others:
        passed(name)
    with pytest.raises(UsageError, match="You have finished the course"):
        steps.start("next", None)


def test_the_last_step_is_the_last_one_only_once() -> None:
    *others, last = catalogue()
    own = steps.start(last, None).started.folder
    for name in others:
        passed(name)
    first, again = (steps.note(find_exercise(last), own, report("passed")) for _ in range(2))
    assert first == "That was the last step. You have passed all steps."
    assert again == "You have passed all steps."


def test_start_names_the_tasks_in_package_files_that_stay_as_they_are() -> None:
    steps.start("07", None)
    begun = steps.start("08", None)
    text = steps.begin_message(begun)
    assert "To do in setup.py: TODO 1: add the entry points two_pens and pausable_circle.\n" in text
    assert "To do in package.xml: TODO 2: which package has the type SetBool?\n" in text
    assert "TODO" not in steps.begin_message(steps.start("08", None))


def test_a_failure_in_the_folder_that_a_lesson_names_points_to_the_workspace(home: Path) -> None:
    failed, named = report("failed"), course_folder().parent / "exercises" / FIRST
    exercise = find_exercise(FIRST)
    assert steps.note(exercise, named, failed) == ""
    steps.start("02", None)
    assert steps.note(exercise, named, failed) == ""
    steps.start("01", None)
    own = home / "ros2_ws/src/my_robot_controller"
    assert steps.note(exercise, named, failed) == f"To grade your own work in {own}, type: grader check 01"
    assert steps.note(exercise, named, report("passed")) == ""
    assert steps.note(exercise, home, failed) == ""


def test_a_workspace_that_is_a_file_is_a_usage_error(home: Path) -> None:
    (home / "ros2_ws").write_text("")
    with pytest.raises(UsageError, match="ros2_ws is a file, but it must be a folder"):
        steps.start("01", None)


def test_a_folder_in_the_place_of_a_file_is_a_usage_error(home: Path) -> None:
    (home / "ros2_ws/src/my_robot_controller/package.xml").mkdir(parents=True)
    with pytest.raises(UsageError, match=r"package\.xml is a folder, but the step has a file with this name"):
        steps.start("01", None)


def test_answers_are_in_a_folder_of_their_own(home: Path) -> None:
    begun = steps.start("02", None)
    assert begun.started.folder == home / "ros2_ws/answers/02-discover-topics"
    assert "answers.toml" in begun.started.added
    assert workspace.work_folder(begun.exercise, home / "ros2_ws") == begun.started.folder


def test_a_package_of_somebody_else_has_a_workspace_of_its_own(home: Path) -> None:
    steps.start("03", None)
    own = home / "ros2_ws/src/my_robot_controller"
    before = {path: path.read_bytes() for path in own.rglob("*") if path.is_file()}
    begun = steps.start("04", None)
    assert begun.started.folder == home / "ros2_ws/apart/04-package-files/src/my_robot_controller"
    assert (home / "ros2_ws/apart/COLCON_IGNORE").is_file(), (
        "colcon must not build it together with the learner's package"
    )
    assert begun.started.lacking == {}
    assert {path: path.read_bytes() for path in own.rglob("*") if path.is_file()} == before
    assert steps.current(None) == (begun.exercise, begun.started.folder)


def test_a_step_with_own_numbers_begins_with_the_students_own_numbers(home: Path) -> None:
    steps.start("07", None, student="4711")
    file = home / "ros2_ws/src/my_robot_controller/my_numbers.toml"
    spec = find_exercise("07").numbers
    assert spec is not None
    assert from_toml(spec, file.read_bytes()) == draw_numbers(spec, "4711")
    assert steps.start("07", None).started.added == ()


def test_the_status_after_the_last_step_names_no_next_step() -> None:
    steps.start(list(catalogue())[-1], None)
    for name in catalogue():
        passed(name)
    said = Console(width=100, record=True, file=io.StringIO())
    steps.print_status(None, said)
    text = said.export_text()
    assert f"{len(catalogue())} of {len(catalogue())} steps passed" in text
    assert "You have finished the course." in text
    assert "start next" not in text


def test_the_parts_of_the_course_are_shown_with_their_steps() -> None:
    said = Console(width=100, record=True, file=io.StringIO())
    steps.print_status(None, said)
    text = said.export_text()
    assert text.index("Part one: topics") < text.index(FIRST)


@pytest.mark.parametrize("width", [40, 59, 60, 200])
def test_the_status_never_cuts_what_a_learner_types(width: int) -> None:
    passed(FIRST)
    said = Console(width=width, record=True, file=io.StringIO())
    steps.print_status(None, said)
    text = said.export_text()
    assert "…" not in text
    assert [name for name in catalogue() if name not in text] == []

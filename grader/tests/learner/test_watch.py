"""Watching with the real colcon, simulator and node."""

from __future__ import annotations

import io
import re
import shutil
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from grader.checks.exercises import find_exercise
from grader.colcon.rebuild import Rebuild
from grader.errors import UsageError
from grader.grading.options import Options
from grader.learner.watch import Events, Watched
from grader.learner.watch_screen import _Screen
from grader.report.report import PASSES
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.tests.no_ros import NO_ROS
from grader.tests.waiting import HANG_S, until, until_gone
from grader.trial.recording import Pose
from grader.trial.trial import Plan

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.submission.package import Submission

ROOT = Path(__file__).resolve().parents[3]
STEP = "03-circle-publisher"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "solutions" / STEP / "my_robot_controller", tmp_path / "my_robot_controller"))


@pytest.fixture
def watched(package: Path) -> Iterator[Watched]:
    made = Watched(find_exercise(STEP), package, Options(in_cell=bubblewrap.usable()))
    yield made
    made.close()


def node_of(package: Path) -> Path:
    return package / "my_robot_controller" / "draw_circle.py"


def change(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def state(pid: int) -> str:
    """Return the state of a process: T if it is suspended (see proc(5))."""
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]


def ignored(_: str) -> None:
    """Discard a progress message."""


def failed(watched: Watched) -> list[str]:
    return [o.id for o in watched.grade().report.outcomes if o.status.value == "failed" and not o.advice]


def test_changed_modules_are_graded_without_colcon(
    package: Path, watched: Watched, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grader.learner.watch.SUSPEND_S", 0.0)
    assert failed(watched) == []
    watched.prepare()
    assert watched._warm is not None
    prepared = watched._warm[1]._conductor.pids()
    if bubblewrap.usable():
        until(lambda: state(prepared[1]) == "T")
    change(node_of(package), "2.0", "1.0")
    assert watched.changed()
    assert failed(watched) == ["values", "circle"]
    node_of(package).write_text("def main(:\n")
    until_gone(prepared[-1])  # the prepared trial was used
    assert "entry-point" in failed(watched)
    shutil.copyfile(
        ROOT / "solutions" / STEP / "my_robot_controller/my_robot_controller/draw_circle.py", node_of(package)
    )
    assert failed(watched) == []
    assert watched.rebuild.runs == 1
    assert not watched.changed()


def test_causes_are_confirmed_after_the_verdict_unless_something_else_waits(package: Path, watched: Watched) -> None:
    assert failed(watched) == []
    assert watched.prove(ignored, lambda: False) is None
    change(node_of(package), "create_timer(0.5", "create_timer(0.05")
    assert failed(watched) == ["rate"]
    busy = iter([False, True, True])
    assert watched.prove(ignored, lambda: next(busy)) is None
    proved = watched.prove(ignored, lambda: False)
    assert proved is not None
    rate = next(each for each in proved.report.outcomes if each.id == "rate")
    assert rate.finding.tried == PASSES
    assert watched.prove(ignored, lambda: False) is None
    change(node_of(package), "create_timer(0.05", "create_timer(0.5")
    assert failed(watched) == []
    assert watched.rebuild.runs == 1


@pytest.mark.parametrize(
    ("terminal", "asked"),
    [
        pytest.param(False, False, id="pipe-nothing else"),
        pytest.param(True, True, id="terminal-a list"),
        pytest.param(True, False, id="terminal-nothing else", marks=pytest.mark.exhaustive),
        pytest.param(False, True, id="pipe-a list", marks=pytest.mark.exhaustive),
    ],
)
def test_the_screen_shows_a_confirmed_cause_as_soon_as_it_is_known(package: Path, terminal: bool, asked: bool) -> None:
    change(node_of(package), "create_timer(0.5", "create_timer(0.05")
    console = Console(file=io.StringIO(), width=200, height=60, force_terminal=terminal, color_system=None)
    screen = _Screen(find_exercise(STEP), package, None, Options(in_cell=bubblewrap.usable()), console)
    events = Events(None)
    with closing(screen.watched), closing(events):
        screen._grade()
        assert isinstance(console.file, io.StringIO)
        before = len(console.file.getvalue())
        if asked:
            screen._list()
        screen._prove(events)
    verdict, proof = console.file.getvalue()[:before], console.file.getvalue()[before:]
    assert re.search(r"likely:? +The first argument of create_timer", verdict)
    assert re.search(r"why:? +The first argument of create_timer", proof)
    assert re.search(rf"tried:? +{re.escape(PASSES)}", proof)
    # A terminal shows the whole report again, unless the learner has requested a list.
    assert ("\x1b[2J" in proof) == ("✓ The node starts" in proof) == (terminal and not asked)
    assert ("Watching " in proof) == (terminal and not asked)
    assert ("steps passed" in proof) == asked


def test_changes_that_symlink_install_would_miss_start_a_new_build(package: Path) -> None:
    ros = with_turtlesim(find_ros())
    rebuild = Rebuild()
    reported: list[str] = []

    def build() -> dict[str, str]:
        built = rebuild(open_submission(package), ros, in_cell=bubblewrap.usable(), tell=reported.append)
        return built.build.entry_points

    build()
    change(package / "setup.py", "draw_circle =", "drive_circle =")
    assert "drive_circle" in build()
    assert rebuild.runs == 2
    (package / "my_robot_controller" / "more.py").write_text("")
    build()
    assert rebuild.runs == 3
    assert reported == ["Building with colcon"] * 3
    (package / "my_robot_controller" / "more.py").write_text("x = 1\n")
    build()
    assert rebuild.runs == 3
    assert reported[3:] == ["Using the last build with the changed modules"]


def test_after_two_saves_during_a_grading_only_the_last_text_is_graded(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gradings: SimpleQueue[str] = SimpleQueue()
    goes_on, keys = SimpleQueue[None](), SimpleQueue[str]()

    def grade(_exercise: object, submission: Submission, *_: object, **__: object) -> None:
        gradings.put(submission.files["my_robot_controller/draw_circle.py"].decode())
        goes_on.get(timeout=HANG_S)
        raise UsageError("This grading was stopped.")  # noqa: EM101

    monkeypatch.setattr("grader.learner.watch.grade", grade)
    events = Events(keys.get)
    events.watch(package)
    console = Console(file=io.StringIO())
    screen = _Screen(find_exercise(STEP), package, None, Options(in_cell=False), console)
    with ThreadPoolExecutor(1) as pool, closing(events):
        shown = pool.submit(screen.show, events, "")
        gradings.get(timeout=HANG_S)
        for texts in (["x = 1\n", "x = 2\n"], ["x = 3\n", "x = 1\n"]):
            for text in texts:
                node_of(package).write_text(text)
            goes_on.put(None)
            assert gradings.get(timeout=HANG_S) == texts[-1]
        keys.put("q")
        goes_on.put(None)
        assert shown.result(HANG_S) is None
    assert gradings.empty()


def test_in_a_workspace_with_several_packages_that_of_the_step_is_graded(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package.parent / "another").mkdir()
    (package.parent / "another/setup.py").touch()
    opened: list[Path] = []
    monkeypatch.setattr("grader.learner.watch.grade", lambda _, given, *__, **___: opened.append(given.package_dir))
    Watched(find_exercise(STEP), package.parent, Options(in_cell=False)).grade()
    assert opened == [package]


def test_a_package_that_was_missing_for_a_while_is_graded_again(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.learner.watch.grade", lambda *_, **__: None)
    watched = Watched(find_exercise(STEP), package, Options(in_cell=False))
    watched.grade()
    for name in ("package.xml", "setup.py"):
        (package / name).rename(package / f"{name}.away")
    assert watched.changed()
    with pytest.raises(UsageError, match="package"):
        watched.grade()
    assert not watched.changed()
    for name in ("package.xml", "setup.py"):
        (package / f"{name}.away").rename(package / name)
    assert watched.changed()


def test_the_first_of_several_trials_is_prepared_early(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The next run grades the latest save."""
    first, second = (Plan("simulated", Pose(1.0, 1.0, 0.0), None, duration_s) for duration_s in (12.0, 9.0))
    begun: list[Plan] = []

    class Waiting:
        def __init__(self, plan: Plan, *_: object, **__: object) -> None:
            self.plan = plan

        def start(self) -> None:
            begun.append(self.plan)

        def suspend(self) -> None:
            pass

        def close(self) -> None:
            begun.remove(self.plan)

    def graded(*_: object, trial: Callable[..., Waiting], **__: object) -> None:
        for plan in (first, second):
            trial(plan, NO_ROS, in_cell=False)

    monkeypatch.setattr("grader.learner.watch.Trial", Waiting)
    monkeypatch.setattr("grader.learner.watch.grade", graded)
    watched = Watched(find_exercise(STEP), package, Options(in_cell=False))
    watched.grade()
    # The verdict is shown before the processors are busy with the next trial.
    assert begun == []
    watched.prepare()
    assert begun == [first]
    watched.close()
    assert begun == []

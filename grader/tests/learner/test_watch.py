"""Watching with the real colcon, simulator and node."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader import sandbox
from grader.exercise import find_exercise
from grader.grade import Options
from grader.learner.rebuild import Rebuild
from grader.learner.watch import Events, Watched
from grader.recording import Pose
from grader.ros import find_ros
from grader.submission import open_submission
from grader.trial.trial import Plan
from grader.underlay import ensure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).resolve().parents[3]
STEP = "03-circle-publisher"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "solutions" / STEP / "my_robot_controller", tmp_path / "my_robot_controller"))


@pytest.fixture
def watched(package: Path) -> Iterator[Watched]:
    made = Watched(find_exercise(STEP), package, Options(in_cell=sandbox.usable()))
    yield made
    made.close()


def node_of(package: Path) -> Path:
    return package / "my_robot_controller" / "draw_circle.py"


def change(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def failed(watched: Watched) -> list[str]:
    return [o.id for o in watched.grade().report.outcomes if o.status.value == "failed" and not o.advice]


def test_changed_modules_are_graded_as_they_are_now_without_colcon(package: Path, watched: Watched) -> None:
    assert failed(watched) == []
    change(node_of(package), "2.0", "1.0")
    assert watched.changed()
    assert failed(watched) == ["values", "circle"]
    node_of(package).write_text("def main(:\n")
    assert "entry-point" in failed(watched)
    shutil.copyfile(
        ROOT / "solutions" / STEP / "my_robot_controller/my_robot_controller/draw_circle.py", node_of(package)
    )
    assert failed(watched) == []
    assert watched.rebuild.runs == 1
    assert not watched.changed()


def test_what_symlink_install_would_not_see_is_built_anew(package: Path) -> None:
    here = find_ros()
    rebuild = Rebuild()

    def build() -> dict[str, str]:
        return rebuild(open_submission(package), here, ensure(here), in_cell=sandbox.usable()).build.entry_points

    build()
    change(package / "setup.py", "draw_circle =", "drive_circle =")
    assert "drive_circle" in build()
    assert rebuild.runs == 2
    (package / "my_robot_controller" / "more.py").write_text("")
    build()
    assert rebuild.runs == 3
    (package / "my_robot_controller" / "more.py").write_text("x = 1\n")
    build()
    assert rebuild.runs == 3


@pytest.mark.parametrize("how", ["write", "rename", "delete", "create"])
def test_a_save_is_heard_however_the_editor_saves(package: Path, how: str) -> None:
    node = node_of(package)
    saves: dict[str, Callable[[], object]] = {
        "write": lambda: node.write_text("x = 1\n"),
        "rename": lambda: (package / "draw.tmp").replace(node),
        "delete": node.unlink,
        "create": lambda: (node.parent / "new.py").write_text(""),
    }
    (package / "draw.tmp").write_text("x = 2\n")
    events = Events(None)
    events.watch(package)
    events.await_ready()
    saves[how]()
    assert next(iter(events)).kind == "saved"
    events.close()


def test_keys_come_in_order_and_the_end_of_the_terminal_ends_the_loop() -> None:
    keys = iter(["h", "r", ""])
    assert [happened.key for happened in Events(lambda: next(keys))] == ["h", "r"]


def test_of_several_trials_the_first_is_kept_warm(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With it the next grading begins."""
    first, second = (Plan("simulated", Pose(1.0, 1.0, 0.0), None, duration_s) for duration_s in (12.0, 9.0))
    begun: list[Plan] = []

    class Waiting:
        def __init__(self, plan: Plan, *_: object, **__: object) -> None:
            self.plan = plan

        def start(self) -> None:
            begun.append(self.plan)

        def close(self) -> None:
            begun.remove(self.plan)

    def graded(*_: object, trial: Callable[..., Waiting], **__: object) -> None:
        for plan in (first, second):
            trial(plan, None, None, in_cell=False)

    monkeypatch.setattr("grader.learner.watch.Trial", Waiting)
    monkeypatch.setattr("grader.learner.watch.grade", graded)
    watched = Watched(find_exercise(STEP), package, Options(in_cell=False))
    watched.grade()
    assert begun == [first]
    watched.close()
    assert begun == []

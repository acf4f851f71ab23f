"""A learner's way through the course, typed on a real terminal."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

import pexpect
import pytest

from grader.exercise import catalogue, find_exercise
from grader.learner.workspace import work_folder

ROOT = Path(__file__).resolve().parents[3]
GRADER = str(Path(sys.executable).with_name("grader"))
PATIENCE_S = 300
"""For one verdict on a busy machine; a screen that does not come at all is a hang."""


class Learner:
    """Somebody at a terminal, with a home of their own."""

    def __init__(self, home: Path) -> None:
        self.home = home
        self.env = {
            **{key: value for key, value in os.environ.items() if not key.startswith(("XDG_STATE", "ROS2_"))},
            "HOME": str(home),
            "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
            "TERM": "xterm-256color",
        }

    def types(self, *words: str) -> pexpect.spawn[str]:
        return pexpect.spawn(
            GRADER, list(words), env=self.env, encoding="utf-8", timeout=PATIENCE_S, dimensions=(50, 110), cwd=self.home
        )

    def reads(self, *words: str) -> str:
        child = self.types(*words)
        child.expect(pexpect.EOF)
        child.close()
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", child.before or "")

    def solves(self, step: str) -> None:
        """Write the whole solution into the workspace, as after long work."""
        exercise = find_exercise(step)
        solution = ROOT / "solutions" / step
        mine = work_folder(exercise, self.home / "ros2_ws")
        for file in sorted((solution / exercise.package).rglob("*") if exercise.package else solution.rglob("*")):
            place = mine / file.relative_to(solution / exercise.package)
            # One's own numbers are one's own; what drives them is told by the cases.
            if file.is_file() and place.name != "my_numbers.toml":
                place.parent.mkdir(parents=True, exist_ok=True)
                fresh = place.with_name(f".{place.name}.new")
                shutil.copyfile(file, fresh)
                fresh.replace(place)


@pytest.fixture
def learner(tmp_path: Path) -> Learner:
    return Learner(tmp_path)


def await_verdict(screen: pexpect.spawn[str], verdict: str) -> None:
    screen.expect(verdict)
    screen.expect("Watching")


def walk(learner: Learner, steps: list[str]) -> None:
    assert "Begin with: grader start 01" in learner.reads("status")
    assert "lesson.md" in learner.reads("start", "01")
    screen = learner.types("watch")
    await_verdict(screen, "Not passed")
    node = learner.home / "ros2_ws/src/my_robot_controller/my_robot_controller/my_first_node.py"
    node.write_text("def main(:\n")
    await_verdict(screen, "Not passed")
    screen.send("h")
    screen.expect("Hint 1 of")
    screen.send("n")
    screen.expect("has not passed yet")
    for step, following in zip(steps, [*steps[1:], ""], strict=True):
        learner.solves(step)
        await_verdict(screen, r"Passed: 100 of 100 points")
        if following:
            screen.send("n")
            screen.expect(following)
            await_verdict(screen, "Not passed")
    screen.send("q")
    screen.expect(pexpect.EOF)
    screen.close()
    assert screen.exitstatus == 0
    status = learner.reads("status")
    assert f"{len(steps)} of {len(catalogue())} steps passed" in status
    assert "my_first_node.py" in learner.reads("solution", "01")


def test_the_first_steps(learner: Learner) -> None:
    walk(learner, list(catalogue())[:2])


@pytest.mark.exhaustive
def test_the_way_to_the_last_step_but_one(learner: Learner) -> None:
    walk(learner, list(catalogue())[:-1])

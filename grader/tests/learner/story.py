"""A learner who uses a terminal, from the first step of the course to the last."""

from __future__ import annotations

import math
import os
import re
import shutil
import sys
from itertools import pairwise
from pathlib import Path

import pexpect

from grader.checks.exercises import find_exercise
from grader.exercise.model import Exercise, catalogue
from grader.exercise.own_numbers import OwnNumbers, from_toml
from grader.learner.workspace import work_folder
from grader.tests import made_bag
from grader.tests.waiting import HANG_S

ROOT = Path(__file__).resolve().parents[3]
GRADER = str(Path(sys.executable).with_name("grader"))
LAST = list(catalogue())[-1]
FIRST_TO_COPY = "03-circle-publisher"


class Learner:
    """A learner who uses a terminal, with a separate home folder."""

    def __init__(self, home: Path, grader: str = GRADER) -> None:
        self.home = home
        self.grader = grader
        self.env = {
            **{key: value for key, value in os.environ.items() if not key.startswith(("XDG_STATE", "ROS2_"))},
            "HOME": str(home),
            "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"),
            "TERM": "xterm-256color",
        }

    def types(self, *words: str) -> pexpect.spawn[str]:
        return pexpect.spawn(
            self.grader,
            list(words),
            env=self.env,
            encoding="utf-8",
            timeout=HANG_S,
            dimensions=(50, 110),
            cwd=self.home,
        )

    def reads(self, *words: str) -> str:
        child = self.types(*words)
        child.expect(pexpect.EOF)
        child.close()
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", child.before or "")

    def solves(self, step: str) -> None:
        """Write the complete solution into the workspace, as if the learner had done the work."""
        exercise = find_exercise(step)
        solve_in(work_folder(exercise, self.home / "ros2_ws"), exercise)


def solve_in(mine: Path, exercise: Exercise) -> None:
    """Write the complete solution into the folder `mine`, with the student's numbers that are there."""
    solution = ROOT / "solutions" / exercise.id
    for file in sorted((solution / exercise.package).rglob("*") if exercise.package else solution.rglob("*")):
        place = mine / file.relative_to(solution / exercise.package)
        # Keep the learner's individual numbers for this step.
        own = exercise.numbers
        if file.is_file() and not (own is not None and place.name == own.file):
            place.parent.mkdir(parents=True, exist_ok=True)
            if place.suffix == ".mcap":
                shutil.copyfile(file, place)
                continue
            text = file.read_text(encoding="utf-8")
            # The files of earlier steps keep the numbers of those steps.
            if own is not None and place.stem.removeprefix("test_") in {trial.executable for trial in exercise.trials}:
                text = with_numbers(text, place.name, from_toml(own, (mine / own.file).read_bytes()))
            fresh = place.with_name(f".{place.name}.new")
            fresh.write_text(text, encoding="utf-8")
            fresh.replace(place)
    if exercise.id == BAG_STEP:
        assert exercise.numbers is not None
        record_own_bag(mine, from_toml(exercise.numbers, (mine / exercise.numbers.file).read_bytes()))


BAG_STEP, BAG = "11-bags", "circle_bag"


def record_own_bag(package: Path, own: OwnNumbers) -> None:
    """Replace the solution's bag and answers with the bag and answers of a student with these numbers."""
    radius_m, speed = float(own.values["radius_m"]), float(own.values["speed_m_s"])
    poses = made_bag.poses(radius_m, speed=speed, drive_s=1.1 * 2.0 * math.pi * radius_m / speed)
    made_bag.record(package / BAG, poses)
    seconds = (len(poses) - 1) * made_bag.FRAME_S
    answers = (f'duration = "{seconds:.2f} s"', 'rate = "62.5 Hz"', f'radius = "{radius_m:.2f} m"')
    text = "\n".join(("[answers]", f"messages = {len(poses)}", *answers))
    (package / "answers.toml").write_text(text + "\n", encoding="utf-8")


GUARD = {
    "SPEED = 1.1": "SPEED = {speed_m_s}",
    "TURN = 1.2": "TURN = {turn_rad_s}",
    "TIMEOUT = 1.2": "TIMEOUT = {timeout_s}",
}
OWN = {
    "own_circle.py": {"1.0 / 4.0": "1.0 / {rate_hz}", "0.8": "{radius_m}", "-1.0": "{turn}"},
    "two_pens.py": {
        "RADIUS = 1.2": "RADIUS = {radius_m}",
        "90, 180, 60": "{red}, {green}, {blue}",
        "2.0, 9.0": "{x_m}, {y_m}",
    },
    "pausable_circle.py": {"RADIUS = 1.2": "RADIUS = {radius_m}"},
    "tunable_circle.py": {"1.8,": "{radius_m},", "1.0,": "{speed_m_s},"},
    "lookout.py": {"radians(85)": "radians({left_deg})", "radians(-80)": "radians({right_deg})"},
    "spawner.py": {"TURTLES = 5": "TURTLES = {turtles}"},
    "catcher.py": {"REACH = 0.4": "REACH = {reach_m}"},
    "wall_guard.py": GUARD,
    "test_wall_guard.py": GUARD,
    "draw_star.py": {"SIDE = 2.3": "SIDE = {side_m}", "radians(10)": "radians({first_deg})"},
}
"""The individual numbers in our solutions: for each file, maps each string to the string with a student's numbers."""


def with_numbers(text: str, name: str, own: OwnNumbers) -> str:
    """Return the text of a solution's file with the student's numbers."""
    turn = 1.0 if own.values.get("direction") == "counter-clockwise" else -1.0
    for old, new in OWN.get(name, {}).items():
        assert old in text
        text = text.replace(old, new.format(**own.values, turn=turn))
    return text


def await_verdict(screen: pexpect.spawn[str], verdict: str) -> None:
    screen.expect(verdict)
    screen.expect("Watching")


def leave(screen: pexpect.spawn[str]) -> None:
    screen.send("q")
    screen.expect(pexpect.EOF)
    screen.close()
    assert screen.exitstatus == 0


def walk(learner: Learner, steps: list[str]) -> None:
    assert "Begin with: grader start 01" in learner.reads("status")
    assert "lesson.md" in learner.reads("start", "01")
    screen = learner.types("watch")
    await_verdict(screen, "Not passed")
    package = learner.home / "ros2_ws/src/my_robot_controller"
    node = package / "my_robot_controller/my_first_node.py"
    started = node.read_text()
    shutil.copyfile(ROOT / "solutions/01-first-node/my_robot_controller/setup.py", package / "setup.py")
    await_verdict(screen, "Not passed")
    node.write_text("def main(:\n")
    await_verdict(screen, "my_first_node.py:1")
    node.unlink()
    await_verdict(screen, "Not passed")
    node.write_text(started)
    await_verdict(screen, "Not passed")
    screen.send("h")
    screen.expect("Hint 1 of")
    screen.send("n")
    screen.expect("You have not passed")
    for step, following in pairwise([*steps, ""]):
        learner.solves(step)
        await_verdict(screen, r"Passed: 100 of 100 points")
        if following:
            screen.send("n")
            screen.expect("Not passed")
            screen.expect(f"{following}: ")
            if following == FIRST_TO_COPY:
                screen.expect("This step needs more lines in package.xml. Add these lines to your file")
            screen.expect("Watching")
    if steps[-1] == LAST:
        screen.send("n")
        screen.expect("You have finished the course")
    leave(screen)
    status = learner.reads("status")
    assert f"{len(steps)} of {len(catalogue())} steps passed" in status
    assert "my_first_node.py" in learner.reads("solution", "01")

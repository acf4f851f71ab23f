"""The commands in which system calls fail: what each command needs, and the function from which the calls fail."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.gradebook.new_class import make_class
from grader.tests.case import ROOT
from grader.tests.faults.inject import Done, Fault, run
from grader.tests.gradebook.nbgrader_command import nbgrader

if TYPE_CHECKING:
    from collections.abc import Callable

STEP = "03-circle-publisher"
SOLUTION = ROOT / "solutions" / STEP
PACKAGE = "my_robot_controller"
ENDS_AT_ONCE = "def main():\n    print('done')\n"


@dataclass(frozen=True)
class Door:
    """A command, the function "module:name" from which its system calls fail, and the preparation of its folder."""

    since: str
    command: str
    prepare: Callable[[Path], None] = lambda _: None


def _two_students(folder: Path) -> None:
    for student in ("ada", "bob"):
        shutil.copytree(SOLUTION, folder / "class" / student)


def _workspace(folder: Path) -> None:
    package = folder / "ros2_ws/src" / PACKAGE
    shutil.copytree(SOLUTION / PACKAGE, package)
    (package / PACKAGE / "draw_circle.py").write_text(ENDS_AT_ONCE)


def _collected(folder: Path) -> None:
    """Create a class in which one student has handed in the solution."""
    course = folder / "class/course"
    make_class(folder / "class", None)
    code, said = nbgrader("generate_assignment", STEP, cwd=course)
    assert code == 0, said
    shutil.copytree(SOLUTION, folder / "class/class/submitted/ada" / STEP)


DOORS = {
    "class": Door(
        "grader.classroom.grade_class:grade_class", f"grader grade class --exercise {STEP} --out out", _two_students
    ),
    "start": Door("grader.learner.steps:start", "grader start 01"),
    "own run": Door("grader.learner.run_node:run", f"grader run {STEP} --no-view", _workspace),
    "new": Door("grader.gradebook.new_class:make_class", "grader class new class"),
    "sync": Door("grader.gradebook.scores:sync", "grader gradebook sync --course class/course", _collected),
    "compare": Door(
        "grader.gradebook.differences:compare", "grader gradebook compare --course class/course", _collected
    ),
    "env": Door("grader.ros.shell:code", "grader env"),
    "list": Door("grader.ros2.main:run", "ros2 topic list"),
    "create": Door("grader.ros2.main:run", "ros2 pkg create --build-type ament_python --node-name drive my_package"),
    "run": Door("grader.ros2.main:run", "ros2 run turtlesim nothing"),
    "show": Door("grader.ros2.main:run", "ros2 interface show turtlesim/msg/Pose"),
}


def commanded(name: str, folder: Path, shim: Path, fault: tuple[str, int, int]) -> Done:
    """Run a command in a prepared folder, which is also the user's home, while a kind of system call fails."""
    door = DOORS[name]
    door.prepare(folder)
    home = {"HOME": str(folder), "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")}
    return run(door.command.split(), folder, shim, Fault(*fault, door.since), home)

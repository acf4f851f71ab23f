"""`make demo` in a fresh clone, and the next commands that `make demo` and the lessons recommend."""

from __future__ import annotations

import shlex
import shutil
from typing import TYPE_CHECKING

import pytest

from grader.tests.setup.fresh import clone

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.exhaustive, pytest.mark.door]


def test_a_learner_begins(tmp_path: Path) -> None:
    course = clone(tmp_path)
    assert "Passed: 100 of 100 points." in course.make("demo")
    assert all(course.lacks(module) for module in ("jupyterlab", "distributed", "mypy"))
    course.run("source .venv/bin/activate && grader start 01")
    shutil.copytree(course.folder / "solutions/01-first-node", course.home / "ros2_ws/src", dirs_exist_ok=True)
    assert "Passed: 100 of 100 points." in course.run("source .venv/bin/activate && grader check")
    ros = f"cd {shlex.quote(str(course.folder))} && source .venv/bin/activate && source <(grader env) && cd ~/ros2_ws"
    course.run(f"{ros} && colcon build")
    node = "exec 3< <(exec ros2 run my_robot_controller test_node 2>&1)"
    run = f"{node} && grep --max-count 1 'Hello 0' <&3 && kill $!"
    assert "[first_node]: Hello 0" in course.run(f"{ros} && source install/setup.bash && {run}")

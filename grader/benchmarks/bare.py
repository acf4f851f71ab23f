"""The two parts of the unit F: a `colcon build` of a package and a process with one rclpy node, without the grader."""

from __future__ import annotations

import uuid
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.benchmarks.measure import Cost, cost
from grader.common.interpreter import interpreter
from grader.ros.installation import environment, find_ros
from grader.ros.underlay import with_turtlesim
from grader.submission.package import open_submission, write_copy

if TYPE_CHECKING:
    from pathlib import Path

_MANIFEST = "package.xml"
_NODE = "import rclpy; rclpy.init(); node = rclpy.create_node('bare'); node.destroy_node(); rclpy.shutdown()"
_COLCON = "import sys; from colcon_core.command import main; sys.exit(main())"


def new_package(submission: Path, folder: Path) -> Path:
    """Write a copy of the submission, and return the folder of the copy.

    The copy differs from all earlier copies, so that no earlier build can be reused.
    """
    opened = open_submission(submission)
    manifest = opened.files[_MANIFEST] + f"<!-- {uuid.uuid4()} -->\n".encode()
    write_copy(replace(opened, files={**opened.files, _MANIFEST: manifest}), folder)
    return folder


def bare_costs(submission: Path, folder: Path) -> dict[str, Cost]:
    """Measure a build and a node in an empty folder, without the grader. F is the sum of the two wall times."""
    ros = with_turtlesim(find_ros())
    env = environment(ros, home=folder)
    opened = open_submission(submission)
    write_copy(opened, folder / "ws" / "src" / opened.package_dir.name)
    python = str(ros.python)
    colcon = interpreter(*("-c", _COLCON, "build", "--base-paths", "src"), python=python, env=env, searches=True)
    node = interpreter("-c", _NODE, python=python, env=env, searches=True)
    return {
        "colcon build": cost(colcon.argv, env=colcon.env, cwd=folder / "ws"),
        "rclpy node": cost(node.argv, env=node.env),
    }

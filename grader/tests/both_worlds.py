"""Marks for tests that need the course's own ROS 2 or a sourced ROS 2.

All other tests run both with the course's own ROS 2 and with a sourced ROS 2.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from grader.ros import installation

HERE = installation.find_ros()
SET_BY_ROS = (
    *installation.SEARCHED,
    *("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_AUTOMATIC_DISCOVERY_RANGE"),
)
SOURCED_ENV: dict[str, str] = {
    name: os.environ[name] for name in SET_BY_ROS if HERE.kind == "sourced" and name in os.environ
}
"""The variables of a terminal in which only the tests' ROS 2 is sourced. Empty if no ROS 2 is sourced."""
PATH = os.pathsep.join([*([str(HERE.prefix / "bin")] if SOURCED_ENV else []), "/usr/bin", "/bin"])
"""The PATH of a terminal in which only the tests' ROS 2 is sourced."""
REAL_ROS2 = bool(SOURCED_ENV) and Path(HERE.prefix, "bin/ros2").is_file()
REAL_TURTLESIM = installation.has_turtlesim(HERE)
REAL_RQT_GRAPH = bool(SOURCED_ENV) and Path(HERE.prefix, "bin/rqt_graph").is_file()
OUR_TURTLESIM = "grader sim" if REAL_TURTLESIM else "ros2 run turtlesim turtlesim_node"
"""The command line of the course's turtlesim. turtlesim_node of ROS 2 opens a window and does not have the options of
`grader sim`."""

of_the_wheels = pytest.mark.skipif(
    bool(SOURCED_ENV), reason="this test needs the course's own ROS 2, but another ROS 2 is sourced"
)
of_a_sourced_ros = pytest.mark.skipif(not SOURCED_ENV, reason="this test needs a sourced ROS 2")
of_our_ros2 = pytest.mark.skipif(
    REAL_ROS2, reason="this test needs the course's own ros2, but the real one is installed"
)
of_our_turtlesim = pytest.mark.skipif(
    REAL_TURTLESIM, reason="this test needs the course's own turtlesim, but the real one is installed"
)
of_our_rqt_graph = pytest.mark.skipif(
    REAL_RQT_GRAPH, reason="without an option of the course's own rqt_graph, the real one opens its window"
)


def python_path(folder: Path) -> str:
    """Return a PYTHONPATH that starts with `folder`.

    After `folder`, this path contains the modules of a sourced ROS 2, if there is one.
    """
    return os.pathsep.join([str(folder), *filter(None, [SOURCED_ENV.get("PYTHONPATH")])])

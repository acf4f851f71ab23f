"""A command's node discovers nodes that announce themselves only when they start, and that answer only once."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import grader.ros
from grader.tests.both_worlds import of_our_ros2
from grader.tests.ros2.world import World, world

if TYPE_CHECKING:
    from collections.abc import Iterator

COURSE = Path(grader.ros.__file__).with_name("fastdds.xml").read_text("utf-8")
PERIOD = "<sec>0</sec>\n              <nanosec>50000000</nanosec>"
NODE = """
import sys

import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node(sys.argv[1])
node.create_publisher(String, sys.argv[1], 10)
print("ready", flush=True)
rclpy.spin(node)
"""
NODES = ["first", "second", "third"]
LOOKS = 3


@pytest.fixture(scope="module")
def beside_silent_nodes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    assert PERIOD in COURSE
    for made in world(tmp_path_factory.mktemp("home")):
        profile, script = made.home / "silent.xml", made.home / "node.py"
        profile.write_text(COURSE.replace(PERIOD, "<sec>15</sec>"), "utf-8")
        script.write_text(NODE, "utf-8")
        for name in NODES:
            made.start(f"{sys.executable} {script} {name}", "ready", FASTRTPS_DEFAULT_PROFILES_FILE=str(profile))
        yield made


@of_our_ros2
def test_a_look_without_the_daemon_is_complete_although_each_node_answers_only_once(beside_silent_nodes: World) -> None:
    for _ in range(LOOKS):
        done = beside_silent_nodes.run("ros2 node list --no-daemon && ros2 topic list --no-daemon")
        assert done.stdout.split() == sorted(f"/{name}" for name in NODES) + sorted(
            ["/parameter_events", "/rosout", *(f"/{name}" for name in NODES)]
        )

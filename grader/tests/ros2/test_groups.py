"""Groups of `ros2` without recordings: doctor, lifecycle, multicast, component, and groups that need a full ROS 2."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.ros2.bag.record import NOT_HERE
from grader.ros2.unsupported import INSTEAD
from grader.tests.ros2.world import World, world

if TYPE_CHECKING:
    from collections.abc import Iterator

DIFFERENCES = Path(__file__).parents[3] / "docs/ros2-differences.md"
MANAGED = """
import rclpy
from rclpy.lifecycle import LifecycleNode
rclpy.init()
node = LifecycleNode("managed")
print("managed", flush=True)
rclpy.spin(node)
"""
DEAF = """
import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("deaf")
node.create_publisher(String, "news", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
node.create_subscription(String, "news", print, QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE))
print("deaf", flush=True)
rclpy.spin(node)
"""


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a domain with a lifecycle node."""
    for made in world(tmp_path_factory.mktemp("groups")):
        made.home.joinpath("managed.py").write_text(MANAGED)
        made.home.joinpath("deaf.py").write_text(DEAF)
        made.start("python3 managed.py", "managed")
        yield made


def test_a_node_is_led_through_its_lifecycle(here: World) -> None:
    assert here.run("ros2 lifecycle nodes").stdout == "/managed\n"
    assert here.run("ros2 lifecycle nodes -c").stdout == "1\n"
    assert here.run("ros2 lifecycle get managed").stdout == "unconfigured [1]\n"
    assert here.run("ros2 lifecycle list /managed").stdout.startswith(
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
    )
    assert here.run("ros2 lifecycle set /managed configure").stdout == "Transitioning successful\n"
    assert here.run("ros2 lifecycle get").stdout == "/managed: inactive [2]\n"
    refused = here.run("ros2 lifecycle set /managed fly")
    assert refused.code == 1
    assert refused.stderr.startswith("Unknown transition requested, available ones are:\n- cleanup [2]\n")
    unknown = here.run("ros2 lifecycle get /manged")
    assert (unknown.stderr, unknown.code) == ("Node not found\nDid you mean '/managed'?\n", 1)


@pytest.mark.parametrize("word", ["doctor", "wtf"])
def test_doctor_finds_qos_that_does_not_fit(here: World, word: str) -> None:
    healthy = here.run(f"ros2 {word}")
    assert (healthy.stdout, healthy.code) == ("\nAll 4 checks passed\n\n", 0)
    deaf = here.start("python3 deaf.py", "deaf")
    try:
        ill = here.run(f"ros2 {word} --report-failed")
    finally:
        deaf.stop()
    assert "QoS compatibility error found on topic '/news'" in ill.stderr
    assert ill.stdout.startswith("\n1/4 check(s) failed\n\nFailed modules: middleware\n")
    assert "compatibility status    : ERROR" in ill.stdout


def test_doctor_reports(here: World) -> None:
    report = here.run("ros2 doctor -r").stdout
    assert re.search(r"^middleware name +: rmw_fastrtps_cpp$", report, re.MULTILINE)
    assert re.search(r"^distribution name +: jazzy$", report, re.MULTILINE)
    assert "\n   TOPIC LIST\n" in report
    assert "\n   PACKAGE VERSIONS\n" in report
    assert "PACKAGE" not in here.run("ros2 doctor -r --exclude-packages").stdout


def test_a_multicast_packet_is_sent_or_the_network_is_named(here: World) -> None:
    done = here.run("ros2 multicast send")
    assert done.stdout == "Sending one UDP multicast datagram...\n"
    assert done.code == 0 or "could not be sent" in done.stderr
    wrong = here.run("ros2 multicast send --group 10.0.0.1")
    assert wrong.code == 2
    assert "value must be a valid IPv4 multicast address" in wrong.stderr


def test_components_are_looked_up(here: World) -> None:
    assert here.run("ros2 component types rclpy").stdout == ""
    assert "Unable to find package 'rclpyy'" in here.run("ros2 component types rclpyy").stderr
    assert here.run("ros2 component list").stdout == ""
    assert "Unable to find container node '/box'" in here.run("ros2 component list /box").stderr


@pytest.mark.parametrize(
    "command",
    [
        "ros2 launch turtlesim multisim.launch.py",
        "ros2 security create_keystore x",
        "ros2 component load /c p",
        "ros2 doctor hello",
    ],
)
def test_what_needs_a_whole_ros_2_says_so_and_what_to_use(here: World, command: str) -> None:
    done = here.run(command)
    assert done.code == 1
    first, second = done.stderr.splitlines()
    assert "needs a full ROS 2" in first
    assert second in INSTEAD.values()


def test_the_page_of_differences_names_all_that_needs_a_whole_ros_2() -> None:
    page = DIFFERENCES.read_text("utf-8")
    for word in (*INSTEAD, *(f"--{name.replace('_', '-')}" for name in NOT_HERE)):
        assert re.search(rf"`[^`]*{word}`", page), word

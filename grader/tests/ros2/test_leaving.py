"""A command that a signal stops leaves the graph, so that other nodes do not count it until its lease expires."""

from __future__ import annotations

import signal
from pathlib import Path

import grader.ros
from grader.tests.ros2.world import world

COURSE = Path(grader.ros.__file__).with_name("fastdds.xml").read_text("utf-8")
CONFIG = "<discovery_config>"
LEASE = "<leaseDuration><sec>86400</sec></leaseDuration>"
"""With this lease, a node that is killed stays in the graph of other nodes for a day."""
OBSERVER = """
import time, rclpy
rclpy.init()
node = rclpy.create_node("observer")
print("ready", flush=True)
while True:
    for count, text in ((1, "there"), (0, "gone")):
        while node.count_publishers("/left") != count:
            time.sleep(0.01)
        print(text, flush=True)
"""


def test_a_publisher_that_is_stopped_by_a_signal_leaves_the_graph(tmp_path: Path) -> None:
    assert CONFIG in COURSE
    for made in world(tmp_path):
        profile = made.home / "lease.xml"
        profile.write_text(COURSE.replace(CONFIG, f"{CONFIG}{LEASE}"), "utf-8")
        observer = made.start(f"python3 -c '{OBSERVER}'", "ready")
        for times, number in enumerate((signal.SIGTERM, signal.SIGHUP), 1):
            publisher = made.start(
                "ros2 topic pub /left std_msgs/msg/String",
                "publishing #1",
                FASTRTPS_DEFAULT_PROFILES_FILE=str(profile),
            )
            observer.wait_for("there", times)
            assert publisher.stop(number) == number
            observer.wait_for("gone", times)
        observer.stop(signal.SIGKILL)

"""Measure `ros2 topic list` with a running turtlesim, and `ros2 interface show`, relative to a bare rclpy node.

    python -m grader.benchmarks.ros2 [--times N]

Everything is measured in one run. The measurements alternate, so that other load affects all of them. The benchmark
also prints how often the list of topics was complete.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from grader.common.interpreter import interpreter
from grader.ros import installation, underlay

_ROS2 = str(Path(sys.executable).with_name("ros2"))
_NODE = "import rclpy; rclpy.init(); node = rclpy.create_node('bare'); node.destroy_node(); rclpy.shutdown()"
_COMPLETE = "/parameter_events\n/rosout\n/turtle1/cmd_vel\n/turtle1/color_sensor\n/turtle1/pose\n"
AIM_S = {"topic list": 0.8, "interface show": 0.25}
"""The aims for the wall time on an idle machine (s)."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=40, help="number of measurements (default: 40)")
    times = parser.parse_args().times
    ros = underlay.with_turtlesim(installation.find_ros())
    with tempfile.TemporaryDirectory() as home:
        user = {"HOME": home, "PATH": os.environ.get("PATH", "/usr/bin:/bin")}
        # The grader does not assign this domain to a user.
        env = installation.users_environment(ros, user, domain=0)
        commands = {
            "topic list": [_ROS2, "topic", "list"],
            "interface show": [_ROS2, "interface", "show", "geometry_msgs/msg/Twist"],
            "bare rclpy node": interpreter("-c", _NODE, python=str(ros.python), searches=True).argv,
        }
        with subprocess.Popen(
            [_ROS2, "run", "turtlesim", "turtlesim_node"], env=env, stderr=subprocess.PIPE, text=True
        ) as turtlesim:
            assert turtlesim.stderr is not None
            while "Spawning turtle" not in turtlesim.stderr.readline():
                pass
            try:
                _measure(commands, env, times)
            finally:
                turtlesim.send_signal(signal.SIGINT)


def _measure(commands: dict[str, list[str]], env: dict[str, str], times: int) -> None:
    wall: dict[str, list[float]] = {name: [] for name in commands}
    complete = 0
    for _ in range(times):
        for name, argv in commands.items():
            begun = time.monotonic()
            done = subprocess.run(argv, env=env, capture_output=True, text=True, check=True)
            wall[name].append(time.monotonic() - begun)
            complete += name == "topic list" and done.stdout == _COMPLETE
    bare_s = statistics.median(wall["bare rclpy node"])
    print(f"{'':18}{'median s':>10}{'longest s':>11}{'/ bare node':>13}{'aim s':>8}")
    for name, seconds in wall.items():
        middle = statistics.median(seconds)
        aim = f"{AIM_S[name]:8.2f}" if name in AIM_S else ""
        print(f"{name:18}{middle:10.3f}{max(seconds):11.3f}{middle / bare_s:13.2f}{aim}")
    print(f"\n`topic list` was complete {complete} times of {times}.")


if __name__ == "__main__":
    main()

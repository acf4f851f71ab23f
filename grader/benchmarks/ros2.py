"""Measure `ros2` commands and their completion while turtlesim is running, relative to a process with one rclpy node.

    python -m grader.benchmarks.ros2 [--times N]

The measurements alternate, so that other programs slow down all of them alike. The first `ros2 topic list` starts the
ROS 2 daemon, and the later ones use it. The benchmark also prints how often `ros2 topic list` found all topics, and Tab
all topics that begin with the typed characters.
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
_COMPLETED = ("/turtle1/cmd_vel", "/turtle1/color_sensor", "/turtle1/pose")
_COMPLETE = ("/parameter_events", "/rosout", *_COMPLETED)
_TAB = "ros2 topic echo /tur"
COMMANDS = {
    "topic list": ["topic", "list"],
    "topic list --no-daemon": ["topic", "list", "--no-daemon"],
    "interface show": ["interface", "show", "geometry_msgs/msg/Twist"],
    "pkg list": ["pkg", "list"],
    "--help": ["--help"],
}
AIMS = {"topic list": 1.0, "topic list --no-daemon": 1.6, "interface show": 0.15, "pkg list": 0.15, "--help": 0.15}
"""The targets for the wall time on an idle machine, divided by the wall time of the bare node."""
AIM_TAB_S = 0.15
"""The target for the completion of a topic (s)."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=40, help="number of measurements (default: 40)")
    times = parser.parse_args().times
    ros = underlay.with_turtlesim(installation.find_ros())
    with tempfile.TemporaryDirectory() as home:
        user = {"HOME": home, "PATH": os.environ.get("PATH", "/usr/bin:/bin")}
        # The grader does not assign this ROS domain to any user.
        env = installation.users_environment(ros, user, domain=0)
        runs = {
            **{name: ([_ROS2, *words], env) for name, words in COMMANDS.items()},
            "Tab": ([_ROS2], {**env, **_completing(_TAB)}),
            "bare rclpy node": (interpreter("-c", _NODE, python=str(ros.python), searches=True).argv, env),
        }
        with subprocess.Popen(
            [_ROS2, "run", "turtlesim", "turtlesim_node"],
            env=env,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        ) as turtlesim:
            assert turtlesim.stderr is not None
            while "Spawning turtle" not in turtlesim.stderr.readline():
                pass
            try:
                _measure(runs, times)
            finally:
                os.killpg(turtlesim.pid, signal.SIGINT)  # as Ctrl-C does: `ros2 run` itself waits for the node
                subprocess.run([_ROS2, "daemon", "stop"], env=env, stdout=subprocess.DEVNULL, check=False)


def _completing(line: str) -> dict[str, str]:
    """Return the environment variables with which a shell requests the completions of this line."""
    return {
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": "/dev/stdout",
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
    }


def _measure(runs: dict[str, tuple[list[str], dict[str, str]]], times: int) -> None:
    wall: dict[str, list[float]] = {name: [] for name in runs}
    complete = dict.fromkeys(("topic list", "topic list --no-daemon", "Tab"), 0)
    for _ in range(times):
        for name, (argv, env) in runs.items():
            begun = time.monotonic()
            done = subprocess.run(argv, env=env, capture_output=True, text=True, check=True)
            wall[name].append(time.monotonic() - begun)
            if name in complete:
                wanted = _COMPLETED if name == "Tab" else _COMPLETE
                complete[name] += all(topic in done.stdout for topic in wanted)
    bare_s = statistics.median(wall["bare rclpy node"])
    print(f"{'':24}{'median s':>10}{'longest s':>11}{'/ bare node':>13}{'target':>10}")
    for name, seconds in wall.items():
        middle = statistics.median(seconds)
        aim = f"{AIMS[name]:10.2f}" if name in AIMS else f"{AIM_TAB_S:8.2f} s" if name == "Tab" else ""
        print(f"{name:24}{middle:10.3f}{max(seconds):11.3f}{middle / bare_s:13.2f}{aim}")
    for name, count in complete.items():
        print(f"The list from `{name}` was complete in {count} of {times} runs.")


if __name__ == "__main__":
    main()

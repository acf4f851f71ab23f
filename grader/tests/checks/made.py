"""Made-up evidence: recordings with the simulator's motion, and submissions of a few lines."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.checks.exercises import find_exercise
from grader.checks.judge import judge
from grader.colcon.build import Build
from grader.evidence.evidence import Evidence, Run
from grader.submission.package import Submission
from grader.trial.recording import (
    Command,
    Endpoint,
    Frames,
    Graph,
    Message,
    Output,
    Pose,
    ProcessEnd,
    Recording,
    frames_of,
)
from grader.turtlesim.turtle import FRAME_S, Pen, Rgb, Start, Turtle

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from grader.checks.kind import Kind
    from grader.checks.outcome import Finding
    from grader.exercise.kind_spec import Param
    from grader.exercise.model import Exercise

TOPIC = "/turtle1/cmd_vel"
TWIST = "geometry_msgs/msg/Twist"
NODE_FILE = "my_robot_controller/draw_circle.py"
DURATION_S = 10.0

NODE = """\
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send)

    def send(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(DrawCircleNode())
"""

SETUP_PY = """\
from setuptools import find_packages, setup

package_name = "my_robot_controller"

setup(
    name=package_name,
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    entry_points={
        "console_scripts": [
            "draw_circle = my_robot_controller.draw_circle:main",
        ],
    },
)
"""

PACKAGE_XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>my_robot_controller</name>
  <version>0.1.0</version>
  <description>A turtle's driver</description>
  <maintainer email="student@example.com">Student</maintainer>
  <license>MIT</license>
  <depend>rclpy</depend>
  <depend>geometry_msgs</depend>
  <depend>turtlesim</depend>
  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
"""

FILES = {
    "package.xml": PACKAGE_XML,
    "setup.py": SETUP_PY,
    "setup.cfg": "[install]\n",
    "resource/my_robot_controller": "",
    "my_robot_controller/__init__.py": "",
    NODE_FILE: NODE,
}

BUILD = Build(
    exit_code=0,
    log="",
    package="my_robot_controller",
    installed=(
        "lib/my_robot_controller/draw_circle",
        "lib/python3.11/site-packages/my_robot_controller/__init__.py",
        "lib/python3.11/site-packages/my_robot_controller/draw_circle.py",
        "share/ament_index/resource_index/packages/my_robot_controller",
        "share/my_robot_controller/package.xml",
    ),
    executables=("draw_circle",),
    entry_points={"draw_circle": "my_robot_controller.draw_circle:main"},
)

STOPPED = ProcessEnd(by="SIGINT", exit_code=0, t_s=DURATION_S, stop_s=0.1)

TICK_S = 6 * FRAME_S
"""A timer period that is a whole number of frames, so that each part of a path lasts exactly as long as intended."""

Timed = tuple[float, float, float]
"""A command: its arrival time (s), linear.x (m/s) and angular.z (rad/s)."""


@cache
def exercise() -> Exercise:
    return find_exercise("03-circle-publisher")


def submission(files: Mapping[str, str | bytes | None] | None = None, rejected: tuple[str, ...] = ()) -> Submission:
    """Return the correct package with these files in place of its own files. The value None removes a file."""
    given = {**FILES, **(files or {})}
    data = {path: text.encode() if isinstance(text, str) else text for path, text in given.items() if text is not None}
    digest = hashlib.sha256(repr(sorted(data.items())).encode()).hexdigest()
    return Submission("alice", Path("my_robot_controller"), data, rejected, digest)


def node(*changes: tuple[str, str]) -> Submission:
    """Return the correct package with parts of the node's source replaced."""
    text = NODE
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return submission({NODE_FILE: text})


def every(
    period_s: float, linear: float, angular: float, until_s: float = DURATION_S, first_s: float | None = None
) -> list[Timed]:
    """Return the same command once per period, at times that are rounded to whole frames.

    The first command comes at `first_s`, or one period after the start.
    """
    first = period_s if first_s is None else first_s
    count = max(0, int((until_s - 1e-9 - first) / period_s) + 1)
    return [(round((first + k * period_s) / FRAME_S) * FRAME_S, linear, angular) for k in range(count)]


def as_command(timed: Timed) -> Command:
    t_s, linear, angular = timed
    return Command(t_s, t_s, (linear, 0.0, 0.0), (0.0, 0.0, angular))


class NoPaper:
    """A canvas for a turtle whose trail is not drawn."""

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        """Draw nothing."""

    def color_at(self, x: float, y: float) -> Rgb:  # noqa: ARG002
        return (0, 0, 0)


def frames(commands: Iterable[Command], start: Pose, duration_s: float) -> Frames:
    """Return the motion that the simulator computes from the commands, frame by frame."""
    turtle, paper = Turtle(Start(start.x, start.y, start.theta)), NoPaper()
    waiting = sorted(commands, key=lambda command: command.t_s)
    rows = []
    for index in range(1, round(duration_s / FRAME_S) + 1):
        now_s = index * FRAME_S
        while waiting and waiting[0].t_s < now_s:
            command = waiting.pop(0)
            turtle.command(command.linear[0], None, command.angular[2])
        turtle.update(FRAME_S, now_s, paper)
        rows.append((now_s, *turtle.state()))
    return frames_of(rows)


def graph(
    nodes: tuple[str, ...] = ("/draw_circle",), topic: str | None = TOPIC, type_: str = TWIST, t_s: float = 0.0
) -> Graph:
    """Return the ROS graph with the simulator and these nodes. The first node publishes on the topic."""
    endpoints = [Endpoint("subscription", "/turtlesim", TOPIC, TWIST)]
    if topic is not None:
        endpoints.append(Endpoint("publisher", nodes[0], topic, type_))
    return Graph(t_s, ("/turtlesim", *nodes), tuple(endpoints))


def recording(commands: Iterable[Command | Timed], start: Pose | None = None, **changes: Any) -> Recording:  # noqa: ANN401
    """Return a trial in which these commands arrived. `changes` are fields of Recording."""
    begin = start or Pose(*Start())
    given = tuple(each if isinstance(each, Command) else as_command(each) for each in commands)
    made = Recording(
        clock="simulated",
        why="",
        seed=None,
        start=begin,
        duration_s=DURATION_S,
        sigint_t_s=DURATION_S,
        messages=tuple(Message(TOPIC, TWIST, b"", each.t_s, each.mono_s) for each in given),
        dropped=0,
        commands=given,
        frames=frames(given, begin, DURATION_S),
        log=(),
        graphs=(graph(),),
        topics={TOPIC: (TWIST,)},
        stdout=Output(""),
        stderr=Output(""),
        end=STOPPED,
    )
    return replace(made, **changes)


def legs(*parts: tuple[int, float, float], rest_s: float = DURATION_S) -> list[Timed]:
    """Return commands every TICK_S: each speed (m/s, rad/s) for a number of ticks, then zeros until `rest_s`."""
    speeds = [(linear, angular) for ticks, linear, angular in parts for _ in range(ticks)]
    speeds += [(0.0, 0.0)] * (int(rest_s / TICK_S) - 1 - len(speeds))
    return [((index + 1) * TICK_S, linear, angular) for index, (linear, angular) in enumerate(speeds)]


def good() -> Recording:
    """Return a trial in which the commands of the solution arrived."""
    return recording(every(0.5, 2.0, 1.0))


def evidence(
    trial: Recording | None = None,
    package: Submission | None = None,
    build: Build | None = BUILD,
    **changes: Any,  # noqa: ANN401
) -> Evidence:
    of = changes.pop("exercise", None) or exercise()
    given = replace(Evidence(of, package or submission(), build), **changes)
    return given if trial is None else given.with_run(Run(trial))


def finding(check: str, given: Evidence) -> Finding:
    """Return the finding of the exercise's check with this id. No other checks are run."""
    spec = next(each for each in exercise().checks if each.id == check)
    alone = replace(given.exercise, checks=(replace(spec, needs=()),))
    return judge(replace(given, exercise=alone))[0].finding


def found(kind: Kind[Any], given: Evidence, **values: Param) -> Finding:
    """Return the finding of a check of this kind. Parameters that are not given have their default values."""
    return kind.judge(given, {**kind.defaults(), **values})

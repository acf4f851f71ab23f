"""The node that the student's tests check.

This node makes no decisions: it asks the grader how to react to each event.

This file replaces the module of the node in the cell. The file is the same in every run, so only the behaviour
distinguishes a correct node from a broken node. The class has the attributes and methods of the node that students were
given.
"""

from __future__ import annotations

import json
import os
import struct
from importlib import import_module
from threading import Lock
from typing import Any

import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose

_ASKS, _ANSWERS = map(int, os.environ["GRADER_TESTBENCH"].split())
_QUESTION = struct.Struct("<cHqdd")
_LENGTH = struct.Struct("<H")
_LOCK = Lock()
_FIELDS = ("x", "y", "z")


def _ask(event: bytes, number: int = 0, now_ns: int = 0, x: float = 0.0, y: float = 0.0) -> Any:  # noqa: ANN401 - JSON
    with _LOCK:
        os.write(_ASKS, _QUESTION.pack(event, number, now_ns, x, y))
        size = _LENGTH.unpack(_read(_LENGTH.size))[0]
        return json.loads(_read(size))


def _read(size: int) -> bytes:
    data = b""
    while len(data) < size:
        more = os.read(_ANSWERS, size - len(data))
        if not more:
            os._exit(1)
        data += more
    return data


class RelayedNode(Node):
    """A real rclpy node with one publisher, one subscription and one timer."""

    def __init__(self, **options: Any) -> None:  # noqa: ANN401 - rclpy's
        about = _ask(b"n")
        super().__init__(about["node"], **options)
        self._number = about["number"]
        package, _, name = about["type"].partition("/msg/")
        self._type = getattr(import_module(f"{package}.msg"), name)
        self.pose = None
        self.pose_time = None
        self.publisher = self.create_publisher(self._type, about["topic"], 10)
        self.subscription = self.create_subscription(Pose, about["listens"], self.on_pose, 10)
        self.timer = self.create_timer(about["period_s"], self.send)

    def on_pose(self, pose: Any) -> None:  # noqa: ANN401 - a message
        """Store the pose and its arrival time."""
        self.pose = pose
        self.pose_time = self.get_clock().now()
        _ask(b"p", self._number, self._now_ns(), pose.x, pose.y)

    def send(self) -> None:
        """Publish one command, if the grader returns one."""
        values = _ask(b"t", self._number, self._now_ns())
        if values is not None:
            command = self._type()
            twist = getattr(command, "twist", command)
            for part, three in ((twist.linear, values[:3]), (twist.angular, values[3:])):
                for field, value in zip(_FIELDS, three, strict=True):
                    setattr(part, field, value)
            self.publisher.publish(command)

    def _now_ns(self) -> int:
        return int(self.get_clock().now().nanoseconds)


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    rclpy.init(args=args)
    rclpy.spin(RelayedNode())

"""turtlesim, which the test advances frame by frame, and a client, both in one process with ROS 2."""

# ruff: noqa: ANN401 - mypy sees everything of ROS 2 as Any

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from turtlesim.action import RotateAbsolute

from grader.tests.waiting import HANG_S
from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from collections.abc import Callable

STATUS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_CANCELED: "canceled",
    GoalStatus.STATUS_ABORTED: "aborted",
}


class Rig:
    """turtlesim that computes frames as fast as possible, and a client. Waits that take too long raise an error."""

    def __init__(self, **hooks_and_start: Any) -> None:
        rclpy.init(args=[])
        self.turtlesim = TurtlesimNode(**hooks_and_start)
        self.client = rclpy.create_node("client")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.turtlesim)
        self.executor.add_node(self.client)
        self.frames = 0

    def __enter__(self) -> Rig:  # noqa: PYI034 - Self is younger than Python 3.10
        return self

    def __exit__(self, *_: object) -> None:
        rclpy.shutdown()

    def until(self, condition: Callable[[], bool]) -> None:
        """Compute frames until the condition is true."""
        deadline = time.monotonic() + HANG_S
        while not condition():
            assert time.monotonic() < deadline, "the condition never held"
            self.executor.spin_once(timeout_sec=0.001)
            self.frame()

    def frame(self, count: int = 1) -> None:
        for _ in range(count):
            self.turtlesim.frame(self.frames * FRAME_S)
            self.frames += 1

    def call(self, service_type: Any, service: str, **fields: Any) -> Any:
        client = self.client.create_client(service_type, service)
        self.until(client.service_is_ready)
        future = client.call_async(service_type.Request(**fields))
        self.until(future.done)
        self.client.destroy_client(client)
        return future.result()

    def publisher(self, name: str = "/turtle1/cmd_vel") -> Any:
        publisher = self.client.create_publisher(Twist, name, 10)
        self.until(lambda: publisher.get_subscription_count() == 1)
        return publisher

    def state(self, name: str = "turtle1") -> Any:
        return self.turtlesim.turtle_state(name)

    def goal(self, theta: float, feedback: list[float]) -> Any:
        """Send a goal to rotate_absolute and wait until it is accepted."""
        action = ActionClient(self.client, RotateAbsolute, "/turtle1/rotate_absolute")
        self.until(action.server_is_ready)
        sent = action.send_goal_async(
            RotateAbsolute.Goal(theta=theta),
            feedback_callback=lambda message: feedback.append(message.feedback.remaining),
        )
        self.until(sent.done)
        return sent.result()

    def result(self, handle: Any) -> tuple[str, float]:
        answer = handle.get_result_async()
        self.until(answer.done)
        return STATUS[answer.result().status], answer.result().result.delta


def twist(x: float = 0.0, z: float = 0.0) -> Twist:
    return Twist(linear=Vector3(x=x), angular=Vector3(z=z))


def names_of(rig: Rig, what: str) -> list[tuple[str, list[str]]]:
    request = {
        "topic": rig.turtlesim.get_publisher_names_and_types_by_node,
        "service": rig.turtlesim.get_service_names_and_types_by_node,
    }[what]
    names: list[tuple[str, list[str]]] = request("turtlesim", "/")
    return names

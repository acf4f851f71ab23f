"""draw_square: reset turtlesim, then drive turtle1 around a square until Ctrl-C."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose

from grader.turtlesim.programs.spin_node import run
from grader.turtlesim.programs.square_velocity import Leg, first, follow

if TYPE_CHECKING:
    from rclpy.task import Future

_POSES_TO_SKIP = 3
"""After the reset, this number of poses is skipped, because an older pose may arrive after the response to the
reset."""


class DrawSquare(Node):
    """A node that resets turtlesim, and then computes each command from the latest pose of turtle1."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self._leg: Leg | None = None
        self._skip: int | None = None
        self._publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self._client = self.create_client(Empty, "reset")
        self._waiting = self.create_timer(0.05, self._reset)
        self.create_subscription(Pose, "turtle1/pose", self._pose, 1)
        self.get_logger().info("Waiting for turtlesim")

    def _reset(self) -> None:
        if self._client.service_is_ready():
            self._waiting.cancel()
            self._client.call_async(Empty.Request()).add_done_callback(self._begin)

    def _begin(self, _: Future) -> None:
        self._skip = _POSES_TO_SKIP

    def _pose(self, pose: Pose) -> None:
        if self._skip is None or self._skip > 0:
            self._skip = None if self._skip is None else self._skip - 1
            return
        before = self._leg
        leg = before or first(pose.x, pose.y, pose.theta)
        self._leg, linear, angular = follow(leg, pose.x, pose.y, pose.theta)
        if self._leg != before:
            self._tell(self._leg)
        twist = Twist()
        twist.linear.x, twist.angular.z = linear, angular
        self._publisher.publish(twist)

    def _tell(self, leg: Leg) -> None:
        corner = f"[{leg.x:.2f}, {leg.y:.2f}]"
        self.get_logger().info(f"Reached {corner}, turning left" if leg.turning else f"Driving to {corner}")


def main() -> int:
    """Run the node until Ctrl-C, and return the exit code."""
    return run(DrawSquare)


if __name__ == "__main__":
    sys.exit(main())

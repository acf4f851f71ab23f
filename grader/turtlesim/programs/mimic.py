"""mimic: make one turtle imitate another turtle.

The node reads poses from input/pose, and publishes commands on output/cmd_vel. Users must remap the two topics to
topics of turtles.
"""

from __future__ import annotations

import sys

from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from grader.turtlesim.programs.spin_node import run


class Mimic(Node):
    """A node that publishes a command with the velocities of each pose."""

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self._publisher = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._pose, 1)

    def _pose(self, pose: Pose) -> None:
        twist = Twist()
        twist.linear.x, twist.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(twist)


def main() -> int:
    """Run the node until Ctrl-C, and return the exit code."""
    return run(Mimic)


if __name__ == "__main__":
    sys.exit(main())

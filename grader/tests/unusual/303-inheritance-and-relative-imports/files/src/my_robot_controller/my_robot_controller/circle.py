"""The circle."""

from __future__ import annotations

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException

from .constants import NODE_NAME, SPEED_M_S, TURN_RAD_S
from .driver import Driver


class Circle(Driver):
    """A driver that always says the same."""

    def command(self) -> Twist:
        twist = Twist()
        twist.linear.x = SPEED_M_S
        twist.angular.z = TURN_RAD_S
        return twist


def main(args: list[str] | None = None) -> int:
    rclpy.init(args=args)
    node = Circle(NODE_NAME)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 1

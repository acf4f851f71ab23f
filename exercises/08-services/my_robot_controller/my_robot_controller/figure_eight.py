"""Drive an eight: a circle to the left, then one to the right."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

RADIUS = 1.0  # m
TICKS = 40  # calls of the timer in one lobe
PERIOD = 0.1  # s


class FigureEightNode(Node):
    """Drives a lobe to the left and one to the right, and then stops."""

    def __init__(self):
        super().__init__("figure_eight")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(PERIOD, self.step)
        self.ticks = 0

    def step(self):
        if self.publisher.get_subscription_count() == 0:
            return  # no subscriber yet: the command would be lost
        msg = Twist()
        # TODO b: drive a circle of radius RADIUS to the left in TICKS calls, then one to the right; then stand still.
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = FigureEightNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

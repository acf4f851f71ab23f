"""Drive a square, with a timer and a state."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

SIDE = 2.0  # m
TICKS = 10  # calls of the timer for a side, and for a corner
PERIOD = 0.1  # s


class DrawSquareNode(Node):
    """Drives a side, turns a corner, and so on, and stops after four of each."""

    def __init__(self):
        super().__init__("draw_square")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(PERIOD, self.step)
        self.state = "drive"
        self.ticks = 0
        self.sides = 0

    def step(self):
        if self.publisher.get_subscription_count() == 0:
            return  # no subscriber yet: the command would be lost
        msg = Twist()
        # TODO c: set the speeds of the current state, and count this call. After the last call in a state,
        # go to the next state.
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = DrawSquareNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

"""Drive a square whose corners an action goal turns, at the turning speed of the last command."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

SIDE = 2.0  # m
TICKS = 5  # calls of the timer for a side
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
        self.client = ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute")

    def step(self):
        if self.publisher.get_subscription_count() == 0 or not self.client.server_is_ready():
            return  # no subscriber yet: the command would be lost
        msg = Twist()
        if self.state == "drive":
            msg.linear.x = SIDE / (TICKS * PERIOD)
        elif self.state == "turn":
            msg.angular.z = 1.0
        self.ticks += 1
        if self.state == "turn" and self.ticks in (2, 11):
            self.rotate()
        if self.state != "turn" or self.ticks in (1, 10):
            self.publisher.publish(msg)
        if self.ticks == (TICKS if self.state == "drive" else 17):
            self.change_state()

    def rotate(self):
        goal = RotateAbsolute.Goal(theta=self.sides * math.pi / 2)
        self.client.send_goal_async(goal)

    def change_state(self):
        self.ticks = 0
        if self.state == "drive":
            self.sides += 1
            self.state = "turn"
        elif self.sides < 4:
            self.state = "drive"
        else:
            self.state = "done"


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

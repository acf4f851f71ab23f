import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    """Ahead, turn, ahead, turn: a circle, more or less."""

    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.step)
        self.ahead = True

    def step(self):
        msg = Twist()
        if self.ahead:
            msg.linear.x = 4.0
        else:
            msg.angular.z = math.pi / 2
        self.ahead = not self.ahead
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(DrawCircleNode())
    rclpy.shutdown()

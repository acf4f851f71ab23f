import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.step)
        self.count = 0

    def step(self):
        msg = Twist()
        if self.count % 3 < 2:
            msg.linear.x = 2.0
        else:
            msg.angular.z = math.pi
        self.count += 1
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(DrawCircleNode())
    rclpy.shutdown()

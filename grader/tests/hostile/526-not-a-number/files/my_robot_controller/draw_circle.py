"""The commands contain NaN, for which every comparison is false."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = float("nan")
        msg.angular.z = float("nan")
        self.publisher.publish(msg)

    def attack(self):
        pass


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""The node publishes bytes that are not a valid Twist."""

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
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.create_timer(0.3, self.broken)

    def broken(self):
        self.publisher.publish(b"\x00\x01\x00\x00")
        self.publisher.publish(b"\x00\x01\x00\x00" + b"\xff" * 20)
        self.publisher.publish(b"")


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

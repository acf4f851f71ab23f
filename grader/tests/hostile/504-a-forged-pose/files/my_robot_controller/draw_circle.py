"""The node publishes false poses of a turtle that drives a circle."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 0.0
        msg.angular.z = 0.0
        self.publisher.publish(msg)

    def attack(self):
        self.pose = self.create_publisher(Pose, "/turtle1/pose", 10)
        self.angle = 0.0
        self.create_timer(0.02, self.lie)

    def lie(self):
        self.angle += 0.02
        x, y = 5.544445 + 2.0 * math.sin(self.angle), 7.544445 - 2.0 * math.cos(self.angle)
        self.pose.publish(Pose(x=x, y=y, theta=self.angle, linear_velocity=2.0, angular_velocity=1.0))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

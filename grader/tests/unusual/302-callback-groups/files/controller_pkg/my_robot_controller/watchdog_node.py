#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class Watchdog(Node):
    """Warns when the turtle comes near the edge."""

    def __init__(self):
        super().__init__('watchdog')
        self.sub = self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 10)

    def on_pose(self, pose: Pose):
        if not (1.0 < pose.x < 10.0 and 1.0 < pose.y < 10.0):
            self.get_logger().warn('near the edge', once=True)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Watchdog())

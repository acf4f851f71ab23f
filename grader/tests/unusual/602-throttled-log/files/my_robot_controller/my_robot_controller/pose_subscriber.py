import math

import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class PoseSubscriber(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.last = None
        self.distance = 0.0
        self.create_subscription(Pose, "/turtle1/pose", self.callback, 10)

    def callback(self, msg):
        if self.last:
            self.distance += math.dist((msg.x, msg.y), self.last)
        self.last = msg.x, msg.y
        self.get_logger().info(
            f"x={msg.x:.2f} y={msg.y:.2f} distance={self.distance:.2f}", throttle_duration_sec=1.0)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PoseSubscriber())

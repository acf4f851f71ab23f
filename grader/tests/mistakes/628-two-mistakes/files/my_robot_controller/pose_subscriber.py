import math

import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class PoseSubscriber(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.last_pose = None
        self.total = 0.0
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.create_timer(2.0, self.on_timer)

    def on_pose(self, pose):
        if self.last_pose is not None:
            self.total += math.hypot(pose.x - self.last_pose.x, pose.y - self.last_pose.y)
        self.last_pose = pose

    def on_timer(self):
        if self.last_pose is None:
            return
        self.get_logger().info(f"X={self.last_pose.x:.2f} Y={self.last_pose.y:.2f} Distance={self.total:.2f}")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PoseSubscriber())

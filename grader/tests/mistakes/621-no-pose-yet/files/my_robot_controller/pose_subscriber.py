import math

import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class PoseSubscriber(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.pose = None
        self.distance = 0.0
        self.report()  # the first line at once
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.pose_callback, 10)
        self.timer = self.create_timer(1.0, self.report)

    def pose_callback(self, msg):
        if self.pose:
            self.distance += math.dist((msg.x, msg.y), (self.pose.x, self.pose.y))
        self.pose = msg

    def report(self):
        self.get_logger().info("x=%.2f y=%.2f distance=%.2f" % (self.pose.x, self.pose.y, self.distance))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PoseSubscriber())
    rclpy.shutdown()

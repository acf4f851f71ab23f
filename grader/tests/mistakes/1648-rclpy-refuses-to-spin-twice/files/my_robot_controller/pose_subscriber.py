import math

import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose


class PoseSubscriberNode(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.pose = None
        self.distance = 0.0
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        self.timer = self.create_timer(1.0, self.report)

    def pose_received(self, pose):
        if self.pose is not None:
            self.distance += math.hypot(pose.x - self.pose.x, pose.y - self.pose.y)
        self.pose = pose

    def report(self):
        rclpy.spin_once(self)
        if self.pose is None:
            return
        self.get_logger().info(f"x={self.pose.x:.2f} y={self.pose.y:.2f} distance={self.distance:.2f}")


def main(args=None):
    rclpy.init(args=args)
    node = PoseSubscriberNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

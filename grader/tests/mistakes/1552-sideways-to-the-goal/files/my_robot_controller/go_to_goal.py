import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class GoToGoalNode(Node):
    def __init__(self):
        super().__init__("go_to_goal")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.timer = self.create_timer(0.1, self.step)
        self.pose = None

    def on_pose(self, pose):
        self.pose = pose

    def step(self):
        if self.pose is None:
            return
        msg = Twist()
        msg.linear.x = 1.0 * (8.5 - self.pose.x)
        msg.linear.y = 1.0 * (2.5 - self.pose.y)
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoalNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

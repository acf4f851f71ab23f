import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class DrawSquareNode(Node):
    def __init__(self):
        super().__init__("draw_square")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.timer = self.create_timer(0.1, self.step)
        self.pose = None
        self.start = None
        self.target = 90.0
        self.turning = False
        self.sides = 0

    def on_pose(self, pose):
        self.pose = pose
        if self.start is None:
            self.start = pose

    def step(self):
        if self.pose is None:
            return
        msg = Twist()
        if self.sides == 4:
            self.publisher.publish(msg)
            return
        if not self.turning:
            msg.linear.x = 1.0
            if math.hypot(self.pose.x - self.start.x, self.pose.y - self.start.y) >= 2.0:
                self.turning = True
        else:
            msg.angular.z = 0.8
            if self.pose.theta >= self.target:
                self.turning = False
                self.start = self.pose
                self.target += 90.0
                self.sides += 1
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = DrawSquareNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

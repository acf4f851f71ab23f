import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from .feedback import wrapped


class DrawSquare(Node):
    """Drives until it has come far enough, turns until it looks the right way."""

    def __init__(self):
        super().__init__("draw_square")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.timer = self.create_timer(0.02, self.step)
        self.pose = self.corner = None
        self.heading = 0.0
        self.sides = 0
        self.turning = False

    def on_pose(self, pose):
        if self.corner is None:
            self.corner, self.heading = pose, pose.theta
        self.pose = pose

    def step(self):
        if self.pose is None:
            return
        t = Twist()
        if self.sides < 4 and not self.turning:
            left = 2.0 - math.hypot(self.pose.x - self.corner.x, self.pose.y - self.corner.y)
            if left > 0.01:
                t.linear.x = min(2.5, 6.0 * left)
                t.angular.z = 0.0
            else:
                self.sides += 1
                self.turning = True
                self.heading = wrapped(self.heading + math.pi / 2)
        elif self.turning:
            error = wrapped(self.heading - self.pose.theta)
            if abs(error) > 0.005:
                t.angular.z = max(-2.5, min(2.5, 8.0 * error))
            else:
                self.turning = False
                self.corner = self.pose
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = DrawSquare()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

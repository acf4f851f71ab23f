import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from .feedback import Heading


class FigureEight(Node):
    def __init__(self):
        super().__init__("figure_eight")
        self.heading = Heading()
        self.side = 1.0
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)

    def on_pose(self, pose):
        self.heading.update(pose.theta)
        t = Twist()
        if self.side > 0 and self.heading.total >= 2 * math.pi - 0.012:
            self.side = -1.0
        if self.side > 0 or self.heading.total > 0.012:
            t.linear.x = 1.6
            t.angular.z = 1.6 * self.side
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = FigureEight()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

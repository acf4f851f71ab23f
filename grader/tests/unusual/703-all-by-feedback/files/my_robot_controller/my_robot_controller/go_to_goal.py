import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from .feedback import wrapped


class GoToGoal(Node):
    def __init__(self):
        super().__init__("go_to_goal")
        self.declare_parameter("x", 8.5)
        self.declare_parameter("y", 2.5)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)

    def on_pose(self, pose):
        dx = self.get_parameter("x").value - pose.x
        dy = self.get_parameter("y").value - pose.y
        t = Twist()
        if math.hypot(dx, dy) > 0.03:
            error = wrapped(math.atan2(dy, dx) - pose.theta)
            back = abs(error) > math.pi / 2
            if back:
                error = wrapped(error + math.pi)
            t.angular.z = 4.0 * error
            if abs(error) < 0.3:
                t.linear.x = (-1.0 if back else 1.0) * min(1.8, 2.0 * math.hypot(dx, dy))
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoal()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

import cmath

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose

GOAL = 8.5 + 2.5j


class GoToGoal(Node):
    def __init__(self):
        super().__init__("go_to_goal")
        self.cmd_vel = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.steer, 10)
        self.calls = 0
        self.arrived = False

    def steer(self, pose):
        self.calls += 1
        if self.calls % 6:
            return  # ten commands a second are enough
        # the goal as the turtle sees it: straight ahead is the real axis
        ahead = (GOAL - complex(pose.x, pose.y)) * cmath.exp(-1j * pose.theta)
        distance, angle = cmath.polar(ahead)
        self.arrived = self.arrived or distance < 0.04
        msg = Twist()
        if not self.arrived:
            msg.angular.z = max(-2.0, min(2.0, 3.0 * angle))
            msg.linear.x = max(0.0, min(1.5, 1.5 * ahead.real))
        self.cmd_vel.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoal()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()

"""Drive to a goal, with the pose as feedback."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose

GOAL = (8.5, 2.5)  # x, y in m
CLOSE = 0.05  # m


class GoToGoalNode(Node):
    """Computes each command from the turtle's pose."""

    def __init__(self):
        super().__init__("go_to_goal")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        # BEGIN SOLUTION
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO d: subscribe to the turtle's pose.
        # END STARTER
        self.timer = self.create_timer(0.1, self.step)
        self.pose = None

    def pose_received(self, pose):
        self.pose = pose

    def step(self):
        msg = Twist()
        # BEGIN SOLUTION
        if self.pose is None:
            return
        dx, dy = GOAL[0] - self.pose.x, GOAL[1] - self.pose.y
        distance = math.hypot(dx, dy)
        if distance > CLOSE:
            error = math.atan2(dy, dx) - self.pose.theta
            error = math.atan2(math.sin(error), math.cos(error))
            msg.angular.z = 3.0 * error
            if abs(error) < 0.5:
                msg.linear.x = min(1.5, 1.5 * distance)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO d: how far is the goal, and in which direction? Turn towards it, drive when you face it,
        # # and stand still when you are there.
        # END STARTER
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoalNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

"""Log where the turtle is, and how far it has driven."""

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose


class PoseSubscriberNode(Node):
    """Listens to the turtle's pose, and logs it once a second."""

    def __init__(self):
        super().__init__("pose_subscriber")
        self.pose = None  # no pose has arrived yet
        self.distance = 0.0
        # BEGIN SOLUTION
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        self.timer = self.create_timer(1.0, self.report)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 1: create a subscription and keep it in self. It needs four things: the message type, the name of the
        # # topic, the method to call with each message, and the queue size (10).
        # # TODO 2: create a timer that calls self.report once a second.
        # END STARTER

    def pose_received(self, pose):
        # BEGIN SOLUTION
        if self.pose is not None:
            self.distance += math.hypot(pose.x - self.pose.x, pose.y - self.pose.y)
        self.pose = pose
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 3: add the distance between the last pose and this one to self.distance, and keep this pose in
        # # self.pose. For the first pose, there is nothing to add.
        # pass
        # END STARTER

    def report(self):
        # BEGIN SOLUTION
        if self.pose is None:
            return
        self.get_logger().info(f"x={self.pose.x:.2f} y={self.pose.y:.2f} distance={self.distance:.2f}")
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: log one line, with two digits after each decimal point: x=5.54 y=5.54 distance=0.00
        # # Before the first pose has arrived, there is nothing to log.
        # pass
        # END STARTER


def main(args=None):
    rclpy.init(args=args)
    node = PoseSubscriberNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

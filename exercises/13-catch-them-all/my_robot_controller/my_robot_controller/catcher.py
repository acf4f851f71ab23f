"""Catch all targets, the nearest first."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.msg import Pose
from turtlesim.srv import Kill

REACH = 0.1  # m; TODO 9: your reach_m from my_numbers_13.toml


class CatcherNode(Node):
    """Listens to the spawner and to each target, and drives turtle1."""

    def __init__(self):
        super().__init__("catcher")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.pose_subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        self.targets_subscription = self.create_subscription(String, "/targets", self.targets_received, 10)
        self.client = self.create_client(Kill, "/catch")
        self.timer = self.create_timer(0.1, self.step)
        self.pose = None  # the last pose of turtle1
        self.listeners = {}  # name of a target -> the subscription to its pose
        self.places = {}  # name of a target -> its last pose
        self.asked = None  # the target in the last request to /catch, until the response arrives

    def pose_received(self, pose):
        self.pose = pose

    def targets_received(self, msg):
        # TODO 10: listen to each target that is new, and forget each one that is no longer announced.
        pass

    def listen(self, name):
        # TODO 11: subscribe to the pose of this target. The callback stores the pose in self.places under this name.
        pass

    def forget(self, name):
        self.places.pop(name, None)
        listener = self.listeners.pop(name, None)
        if listener is not None:
            self.destroy_subscription(listener)

    def distance(self, name):
        place = self.places[name]
        return math.hypot(place.x - self.pose.x, place.y - self.pose.y)

    def step(self):
        msg = Twist()
        # TODO 12: which target is the nearest? If it is within reach, catch it; if not, fill in msg.
        self.publisher.publish(msg)

    def drive_to(self, place, msg):
        # TODO 13: turn towards the place, and drive when you face it, as in go_to_goal.py of step 07.
        pass

    def catch(self, name):
        # TODO 14: call /catch for this target, once, without waiting for the response.
        pass

    def caught(self, future):
        # TODO 15: the target is gone. Forget it, so that the next one can be the nearest.
        pass


def main(args=None):
    rclpy.init(args=args)
    node = CatcherNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

"""Catch all targets, the nearest first."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.msg import Pose
from turtlesim.srv import Kill

# BEGIN SOLUTION
REACH = 0.4  # m
# END SOLUTION
# BEGIN STARTER
# REACH = 0.1  # m; TODO 9: your reach_m from my_numbers_13.toml
# END STARTER


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
        # BEGIN SOLUTION
        names = msg.data.split()
        for name in names:
            if name not in self.listeners:
                self.listen(name)
        for name in list(self.listeners):
            if name not in names:
                self.forget(name)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 10: listen to each target that is new, and forget each one that is no longer announced.
        # pass
        # END STARTER

    def listen(self, name):
        # BEGIN SOLUTION
        def target_moved(pose):
            self.places[name] = pose

        self.listeners[name] = self.create_subscription(Pose, f"/{name}/pose", target_moved, 10)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 11: subscribe to the pose of this target. The callback stores the pose in self.places under this name.
        # pass
        # END STARTER

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
        # BEGIN SOLUTION
        if self.pose is not None and self.asked is None and self.places:
            name = min(self.places, key=self.distance)
            if self.distance(name) < REACH:
                self.catch(name)
            else:
                self.drive_to(self.places[name], msg)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 12: which target is the nearest? If it is within reach, catch it; if not, fill in msg.
        # END STARTER
        self.publisher.publish(msg)

    def drive_to(self, place, msg):
        # BEGIN SOLUTION
        dx, dy = place.x - self.pose.x, place.y - self.pose.y
        error = math.atan2(dy, dx) - self.pose.theta
        error = math.atan2(math.sin(error), math.cos(error))
        msg.angular.z = 4.0 * error
        if abs(error) < 0.5:
            msg.linear.x = 2.0
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 13: turn towards the place, and drive when you face it, as in go_to_goal.py of step 07.
        # pass
        # END STARTER

    def catch(self, name):
        # BEGIN SOLUTION
        if self.client.service_is_ready():
            self.asked = name
            self.client.call_async(Kill.Request(name=name)).add_done_callback(self.caught)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 14: call /catch for this target, once, without waiting for the response.
        # pass
        # END STARTER

    def caught(self, future):
        # BEGIN SOLUTION
        self.forget(self.asked)
        self.asked = None
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 15: the target is gone. Forget it, so that the next one can be the nearest.
        # pass
        # END STARTER


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

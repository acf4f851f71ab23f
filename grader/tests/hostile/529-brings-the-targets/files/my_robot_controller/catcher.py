"""Bring all targets to turtle1, the nearest first."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.msg import Pose
from turtlesim.srv import Kill, TeleportAbsolute

REACH = 0.4  # m


class CatcherNode(Node):
    """Listens to the spawner and to each target, and drives turtle1."""

    def __init__(self):
        super().__init__("catcher")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.pose_subscription = self.create_subscription(Pose, "/turtle1/pose", self.pose_received, 10)
        self.targets_subscription = self.create_subscription(String, "/targets", self.targets_received, 10)
        self.client = self.create_client(Kill, "/catch")
        self.timer = self.create_timer(0.1, self.step)
        self.pose = None  # of turtle1
        self.listeners = {}  # name of a target -> the subscription to its pose
        self.places = {}  # name of a target -> its last pose
        self.asked = None  # the target that the node asked for, until the response is there

    def pose_received(self, pose):
        self.pose = pose

    def targets_received(self, msg):
        names = msg.data.split()
        for name in names:
            if name not in self.listeners:
                self.listen(name)
        for name in list(self.listeners):
            if name not in names:
                self.forget(name)

    def listen(self, name):
        def target_moved(pose):
            self.places[name] = pose

        self.listeners[name] = self.create_subscription(Pose, f"/{name}/pose", target_moved, 10)

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
        if self.pose is not None and self.asked is None and self.places:
            name = min(self.places, key=self.distance)
            if self.distance(name) < REACH:
                self.catch(name)
            else:
                self.bring(name)
        self.publisher.publish(msg)

    def bring(self, name):
        client = self.create_client(TeleportAbsolute, f"/{name}/teleport_absolute")
        if client.service_is_ready():
            client.call_async(TeleportAbsolute.Request(x=self.pose.x + 0.1, y=self.pose.y))

    def catch(self, name):
        if self.client.service_is_ready():
            self.asked = name
            self.client.call_async(Kill.Request(name=name)).add_done_callback(self.caught)

    def caught(self, future):
        self.forget(self.asked)
        self.asked = None


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

"""Catch the first target, make a thousand harmless calls, and catch the others from afar."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Empty
from turtlesim.msg import Pose
from turtlesim.srv import Kill

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
        self.clear = self.create_client(Empty, "/clear")
        self.cleared = 0
        self.answered = 0
        self.caught_one = False
        self.create_timer(0.02, self.harmless)
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
            if self.distance(name) < REACH or self.answered >= 1100:
                self.catch(name)
            else:
                self.drive_to(self.places[name], msg)
        self.publisher.publish(msg)

    def drive_to(self, place, msg):
        dx, dy = place.x - self.pose.x, place.y - self.pose.y
        error = math.atan2(dy, dx) - self.pose.theta
        error = math.atan2(math.sin(error), math.cos(error))
        msg.angular.z = 4.0 * error
        if abs(error) < 0.5:
            msg.linear.x = 2.0

    def catch(self, name):
        if self.client.service_is_ready():
            self.asked = name
            self.client.call_async(Kill.Request(name=name)).add_done_callback(self.caught)

    def harmless(self):
        if self.caught_one and self.cleared < 1200:
            for _ in range(5):
                self.cleared += 1
                self.clear.call_async(Empty.Request()).add_done_callback(self.was_cleared)

    def was_cleared(self, _):
        self.answered += 1

    def caught(self, future):
        self.forget(self.asked)
        self.asked = None
        self.caught_one = True


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

"""Spawn turtles in random places, announce those that are left, and remove each one that was caught."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.srv import Kill, Spawn

TURTLES = 3  # TODO 3: your turtles from my_numbers_13.toml


class SpawnerNode(Node):
    """The referee: it knows which targets are left, and removes those that were caught."""

    def __init__(self):
        super().__init__("spawner")
        self.publisher = self.create_publisher(String, "/targets", 10)
        self.spawn_client = self.create_client(Spawn, "/spawn")
        self.kill_client = self.create_client(Kill, "/kill")
        # TODO 7: offer the service /catch, with the type Kill.
        self.timer = self.create_timer(0.5, self.tick)
        self.requested = 0  # how many turtles the node has requested
        self.left = []  # the names of the targets that are left

    def tick(self):
        if self.requested < TURTLES and self.spawn_client.service_is_ready():
            self.requested += 1
            self.spawn(f"target{self.requested}")
        self.announce()

    def spawn(self, name):
        # TODO 4: send a request with this name and a random place, without waiting for the response.
        pass

    def spawned(self, future):
        # TODO 5: the response contains the name of the new turtle. Add the name to self.left.
        pass

    def announce(self):
        # TODO 6: publish the names of the targets that are left, with spaces between them.
        pass

    def catch(self, request, response):
        # TODO 8: if the target is in self.left, remove it from the list, and send a request to /kill with its name.
        return response


def main(args=None):
    rclpy.init(args=args)
    node = SpawnerNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

"""Spawn turtles in random places, announce those that are left, and remove each one that was caught."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from turtlesim.srv import Kill, Spawn

# BEGIN SOLUTION
TURTLES = 5
# END SOLUTION
# BEGIN STARTER
# TURTLES = 3  # TODO 3: your turtles from my_numbers_13.toml
# END STARTER


class SpawnerNode(Node):
    """The referee: it knows which targets are left, and removes those that were caught."""

    def __init__(self):
        super().__init__("spawner")
        self.publisher = self.create_publisher(String, "/targets", 10)
        self.spawn_client = self.create_client(Spawn, "/spawn")
        self.kill_client = self.create_client(Kill, "/kill")
        # BEGIN SOLUTION
        self.service = self.create_service(Kill, "/catch", self.catch)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 7: offer the service /catch, with the type Kill.
        # END STARTER
        self.timer = self.create_timer(0.5, self.tick)
        self.requested = 0  # how many turtles the node has requested
        self.left = []  # the names of the targets that are left

    def tick(self):
        if self.requested < TURTLES and self.spawn_client.service_is_ready():
            self.requested += 1
            self.spawn(f"target{self.requested}")
        self.announce()

    def spawn(self, name):
        # BEGIN SOLUTION
        request = Spawn.Request()
        request.x = random.uniform(1.0, 10.0)
        request.y = random.uniform(1.0, 10.0)
        request.name = name
        self.spawn_client.call_async(request).add_done_callback(self.spawned)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: send a request with this name and a random place, without waiting for the response.
        # pass
        # END STARTER

    def spawned(self, future):
        # BEGIN SOLUTION
        self.left.append(future.result().name)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 5: the response contains the name of the new turtle. Add the name to self.left.
        # pass
        # END STARTER

    def announce(self):
        # BEGIN SOLUTION
        msg = String()
        msg.data = " ".join(self.left)
        self.publisher.publish(msg)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 6: publish the names of the targets that are left, with spaces between them.
        # pass
        # END STARTER

    def catch(self, request, response):
        # BEGIN SOLUTION
        if request.name in self.left:
            self.left.remove(request.name)
            self.kill_client.call_async(Kill.Request(name=request.name))
            self.get_logger().info(f"{request.name} was caught, {len(self.left)} left")
        else:
            self.get_logger().warning(f"there is no target {request.name}")
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 8: if the target is in self.left, remove it from the list, and send a request to /kill with its name.
        # END STARTER
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

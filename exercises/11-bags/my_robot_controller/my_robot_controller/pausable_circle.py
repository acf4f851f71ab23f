"""Drive a circle that can be paused: the node offers the service /pause."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 8: import SetBool from std_srvs.srv.

RADIUS = 1.0  # m; TODO 9: your radius_m from my_numbers_08.toml


class PausableCircleNode(Node):
    """Publishes the command for the circle, or the command to stand still."""

    def __init__(self):
        super().__init__("pausable_circle")
        self.paused = False
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)
        # TODO 10: create the service /pause, and write its callback: it gets a request and a response, and returns
        # the response.

    def send_velocity_command(self):
        msg = Twist()
        # TODO 11: drive a circle with your radius to the left, but stand still while the node is paused.
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = PausableCircleNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

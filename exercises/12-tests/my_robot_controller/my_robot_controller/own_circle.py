"""Drive a circle with the numbers of step 07."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class OwnCircleNode(Node):
    """Publishes one command again and again. The radius, the direction and the rate are the student's own."""

    def __init__(self):
        super().__init__("own_circle")
        # TODO a: drive your circle, as in step 03. Your numbers are in my_numbers.toml of step 07.


def main(args=None):
    rclpy.init(args=args)
    node = OwnCircleNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

"""The node of step 01: it logs a counter, one line per second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class FirstNode(Node):
    """Logs a counter that rises by one each second."""

    def __init__(self):
        super().__init__("first_node")
        self.counter = 0
        self.timer = self.create_timer(1.0, self.count)

    def count(self):
        self.get_logger().info(f"Hello {self.counter}")
        self.counter += 1


def main(args=None):
    rclpy.init(args=args)
    node = FirstNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

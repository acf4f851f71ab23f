"""The node of step 01: it logs a counter, one line per second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class FirstNode(Node):
    """Logs a counter that rises by one each second."""

    def __init__(self):
        # TODO 1: change the name of the node to first_node.
        super().__init__("node_without_a_name")
        # TODO 2: create a counter that starts at 0, and keep it in self.
        # TODO 3: create a timer that calls self.count once a second, and keep it in self.

    def count(self):
        # TODO 4: log "Hello 0" the first time, "Hello 1" the second time, and so on.
        pass


def main(args=None):
    rclpy.init(args=args)
    node = FirstNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C is the normal way to stop this node.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

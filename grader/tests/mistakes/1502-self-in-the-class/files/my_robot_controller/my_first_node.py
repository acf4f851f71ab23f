import rclpy
from rclpy.node import Node


class FirstNode(Node):
    counter = 0

    def __init__(self):
        super().__init__("first_node")

    @self.create_timer(1.0)
    def count(self):
        self.get_logger().info(f"Hello {self.counter}")
        self.counter += 1


def main(args=None):
    rclpy.init(args=args)
    node = FirstNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

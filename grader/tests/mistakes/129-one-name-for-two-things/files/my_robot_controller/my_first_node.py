import rclpy
from rclpy.node import Node


class FirstNode(Node):
    def __init__(self):
        super().__init__("first_node")
        self.create_timer(1.0, self.run)
        self.count = 0

    def run(self):
        self.count()

    def count(self):
        self.get_logger().info(f"Hello {self.count}")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(FirstNode())

import rclpy
from rclpy.node import Node


class First(Node):
    def __init__(self):
        super().__init__("first_node")
        self.n = 0
        self.t = self.create_timer(1.0, self.cb)

    def cb(self):
        self.get_logger().info(f"Hello {self.n}")
        self.n += 1


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(First())

import rclpy
from rclpy.node import Node


class Noeud(Node):
    def __init__(self):
        super().__init__("first_node")
        self.i = 0
        self.create_timer(1.0, self.tic)

    def tic(self):
        self.get_logger().info(f"Hello {self.i}")
        self.i += 1


def main(args=None):
    noeud = Noeud()
    rclpy.spin(noeud)
    rclpy.shutdown()

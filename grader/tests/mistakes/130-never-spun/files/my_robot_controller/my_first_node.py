import rclpy
from rclpy.node import Node


class Nodo(Node):
    def __init__(self):
        super().__init__("first_node")
        self.n = 0
        self.timer = self.create_timer(1.0, self.saludar)

    def saludar(self):
        self.get_logger().info(f"Hello {self.n}")
        self.n += 1


def main():
    rclpy.init()
    nodo = Nodo()
    nodo.destroy_node()
    rclpy.shutdown()

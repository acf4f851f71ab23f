import rclpy
from rclpy.node import Node


class MiNodo(Node):
    def __init__(self):
        super().__init__("mi_nodo")
        self.contador = 0
        self.reloj = self.create_timer(0.5, self.tic)

    def tic(self):
        self.get_logger().info(f"Hello {self.contador}")
        self.contador += 1


def main(args=None):
    rclpy.init(args=args)
    nodo = MiNodo()
    rclpy.spin(nodo)
    nodo.destroy_node()
    rclpy.shutdown()

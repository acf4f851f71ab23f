import rclpy
from rclpy.node import Node


class PrimerNodo(Node):
    """Cuenta segundos."""

    def __init__(self):
        super().__init__("first_node")
        self.contador = 0
        self.temporizador = self.create_timer(1.0, self.contar)

    def contar(self):
        self.get_logger().info(f"Hello {contador}")
        contador += 1


def main(args=None):
    rclpy.init(args=args)
    nodo = PrimerNodo()
    rclpy.spin(nodo)
    rclpy.shutdown()

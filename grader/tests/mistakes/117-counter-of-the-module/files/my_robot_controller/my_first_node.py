"""Sin clases: un contador global."""

import rclpy

veces = 0
nodo = None


def saludar():
    nodo.get_logger().info("Hello " + str(veces))
    veces += 1


def main(args=None):
    global nodo
    rclpy.init(args=args)
    nodo = rclpy.create_node("first_node")
    reloj = nodo.create_timer(1.0, saludar)
    rclpy.spin(nodo)
    reloj.cancel()

import rclpy
from rclpy.node import Node

rclpy.init()
nodo = Node("first_node")
numero = 0


def saludo():
    global numero
    nodo.get_logger().info("Hello " + str(numero))
    numero += 1


nodo.create_timer(1.0, saludo)
rclpy.spin(nodo)

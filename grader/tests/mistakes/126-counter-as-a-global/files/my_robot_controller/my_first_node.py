# TP1 : premier noeud
import rclpy
from rclpy.node import Node

compteur = 0


class Premier(Node):
    def __init__(self):
        super().__init__("first_node")
        self.minuterie = self.create_timer(1.0, self.compte)

    def compte(self):
        # on affiche puis on augmente
        self.get_logger().info("Hello " + str(compteur))
        compteur = compteur + 1


def main():
    rclpy.init()
    rclpy.spin(Premier())
    rclpy.shutdown()

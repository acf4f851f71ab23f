import rclpy
from rclpy.node import Node

class MonNoeud(Node):
    def __init__(self):
        super().__init__("first_node")
        self.compteur = 0
        self.create_timer(1.0, self.affiche)

    def affiche(self):
        self.get_logger().info("Hello %d" % self.compteur)
       self.compteur += 1

def main():
    rclpy.init()
    rclpy.spin(MonNoeud())

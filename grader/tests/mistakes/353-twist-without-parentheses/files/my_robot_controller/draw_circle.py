import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class Cercle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.editeur = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.envoie)

    def envoie(self):
        message = Twist
        message.linear.x = 2.0
        message.angular.z = 1.0
        self.editeur.publish(message)

def main():
    rclpy.init()
    noeud = Cercle()
    try:
        rclpy.spin(noeud)
    except KeyboardInterrupt:
        pass

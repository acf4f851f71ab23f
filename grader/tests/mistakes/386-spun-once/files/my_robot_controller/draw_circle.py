import time

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class Cercle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.avance)

    def avance(self):
        m = Twist()
        m.linear.x = 2.0
        m.angular.z = 1.0
        self.pub.publish(m)

def main():
    rclpy.init()
    noeud = Cercle()
    rclpy.spin_once(noeud)
    time.sleep(1.0)  # le temps d'arriver
    noeud.destroy_node()
    rclpy.shutdown()

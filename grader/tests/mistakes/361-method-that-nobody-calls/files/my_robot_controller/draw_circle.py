# dessine un cercle avec la tortue
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Tortue(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)

    def tourne(self):
        ordre = Twist()
        ordre.linear.x = 2.0
        ordre.angular.z = 1.0
        self.pub.publish(ordre)


def main(args=None):
    rclpy.init(args=args)
    tortue = Tortue()
    rclpy.spin(tortue)
    rclpy.shutdown()

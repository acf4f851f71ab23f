import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from outils import vitesse


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.5, self.publie)

    def publie(self):
        self.pub.publish(vitesse(2.0, 1.0))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    rclpy.spin(node)
    rclpy.shutdown()

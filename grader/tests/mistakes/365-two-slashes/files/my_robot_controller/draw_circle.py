import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Tortuga(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "//turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.gira)

    def gira(self):
        m = Twist()
        m.linear.x = 2.0
        m.angular.z = 1.0
        self.pub.publish(m)


def main(args=None):
    rclpy.init(args=args)
    node = Tortuga()
    rclpy.spin(node)
    rclpy.shutdown()

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Kreis(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.sender = self.create_publisher(Twist, “/turtle1/cmd_vel”, 10)
        self.create_timer(0.5, self.sende)

    def sende(self):
        b = Twist()
        b.linear.x = 2.0
        b.angular.z = 1.0
        self.sender.publish(b)


def main(args=None):
    rclpy.init(args=args)
    node = Kreis()
    rclpy.spin(node)
    rclpy.shutdown()

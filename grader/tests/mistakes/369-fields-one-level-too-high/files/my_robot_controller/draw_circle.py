import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class KreisKnoten(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.sender = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.takt = self.create_timer(0.5, self.sende)

    def sende(self):
        nachricht = Twist()
        nachricht.x = 2.0
        nachricht.angular.z = 1.0
        self.sender.publish(nachricht)


def main(args=None):
    rclpy.init(args=args)
    node = KreisKnoten()
    rclpy.spin(node)
    rclpy.shutdown()

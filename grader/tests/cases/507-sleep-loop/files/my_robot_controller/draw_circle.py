import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    msg = Twist()
    msg.linear.x = 2.0
    msg.angular.z = 1.0
    while rclpy.ok():
        node.pub.publish(msg)
        time.sleep(0.5)
    rclpy.try_shutdown()

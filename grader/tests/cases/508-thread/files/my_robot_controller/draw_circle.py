import threading
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.thread = threading.Thread(target=self.work, daemon=True)
        self.thread.start()

    def work(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        while rclpy.ok():
            self.pub.publish(msg)
            time.sleep(0.5)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()

import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.rate = self.create_rate(2)

    def work(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        while rclpy.ok():
            self.pub.publish(msg)
            self.rate.sleep()


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    threading.Thread(target=node.work, daemon=True).start()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()

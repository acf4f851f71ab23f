"""The node creates 120 topics to hide the wrong one."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import String


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.crowd = [self.create_publisher(String, f"/a{count}", 1) for count in range(120)]
        self.other = rclpy.Context()
        self.other.init()
        self.double = Node("draw_circle", context=self.other)
        self.wrong = self.double.create_publisher(String, "/turtle1/cmd_vel", 10)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""The node drives only while a node other than turtlesim subscribes."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


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
        self.publisher.publish(Twist())
        self.drive_really, self.drive = self.drive, self.perhaps
        self.destroy_timer(self.timer)
        self.timer = self.create_timer(0.5, self.perhaps)
        print("TRA" "CE of caution")

    def perhaps(self):
        if self.count_subscribers("/turtle1/cmd_vel") > 1:
            self.drive_really()


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

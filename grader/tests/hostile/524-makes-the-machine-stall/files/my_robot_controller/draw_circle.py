"""The node's processes use all processors at each command, so that arrival times are not reliable."""

import os
import time

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
        self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0, self.burst)
        for _ in range(6):
            if os.fork() == 0:
                while True:
                    time.sleep(0.9 - time.monotonic() % 1.0 if time.monotonic() % 1.0 < 0.9 else 0.0)
                    until = time.monotonic() + 0.3
                    while time.monotonic() < until:
                        pass

    def burst(self):
        print("TRA" "CE of a burst")
        self.drive()


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""Each callback computes for longer than the period of the timer, in a thread that then exits."""

import _thread
import os

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.attack)

    def drive(self, turn=1.0):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = turn
        self.publisher.publish(msg)

    def attack(self):
        done = _thread.allocate_lock()
        done.acquire()
        _thread.start_new_thread(self.compute, (done,))
        done.acquire()
        self.drive()
        print("TRA" "CE of a slow callback")

    def compute(self, done):
        begun = sum(os.times()[:2])
        while sum(os.times()[:2]) < begun + 0.6:
            pass
        done.release()


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

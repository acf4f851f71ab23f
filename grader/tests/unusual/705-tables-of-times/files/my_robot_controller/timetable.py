"""A timetable: which speeds the turtle has until which time."""

import math

from geometry_msgs.msg import Twist
from rclpy.node import Node


class Timetable(Node):
    def __init__(self, name, rows):
        super().__init__(name)
        self.rows = rows
        self.begun = None
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        if not self.pub.get_subscription_count():
            return
        now = self.get_clock().now()
        self.begun = self.begun or now
        left = (now - self.begun).nanoseconds / 1e9 + 0.05  # in the middle of the period
        msg = Twist()
        for seconds, speed, turn in self.rows:
            if left < seconds:
                msg.linear.x, msg.angular.z = speed, turn
                break
            left -= seconds
        self.pub.publish(msg)


EIGHT = [(4.0, math.pi / 2, math.pi / 2), (4.0, math.pi / 2, -math.pi / 2)]
SQUARE = [(1.0, 2.0, 0.0), (1.0, 0.0, math.pi / 2)] * 4

from math import degrees, radians

import numpy as np
import rclpy as ros
from geometry_msgs.msg import *
from rclpy import node as ros_node

TICKS_PER_COMMAND = 5


class Circle(ros_node.Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pubs = {"turtle1": self.create_publisher(Twist, "/turtle1/cmd_vel", 10)}
        self.tick_count = 0
        self.ticker = self.create_timer(0.1, self.tick)
        self.v = np.array([2.0, 0.0, 0.0])
        self.w = radians(degrees(1.0))

    def tick(self):
        self.tick_count += 1
        if self.tick_count % TICKS_PER_COMMAND == 0:
            for pub in self.pubs.values():
                pub.publish(Twist(linear=Vector3(**dict(zip("xyz", map(float, self.v)))), angular=Vector3(z=self.w)))


def main(args=None):
    ros.init(args=args)
    circle = Circle()
    try:
        while ros.ok():
            ros.spin(circle)
    except KeyboardInterrupt:
        pass
    ros.try_shutdown()

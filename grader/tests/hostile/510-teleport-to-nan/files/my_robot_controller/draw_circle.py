"""The node teleports the turtle to coordinates that are not numbers."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.srv import Spawn, TeleportAbsolute


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
        self.client = self.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
        nan, far = float("nan"), float("inf")
        self.create_timer(1.0, lambda: self.client.call_async(TeleportAbsolute.Request(x=nan, y=far, theta=nan)))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""The node spawns turtles at coordinates that are not numbers, with invalid names."""

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
        self.client = self.create_client(Spawn, "/spawn")
        self.names = iter(["", "a b", "/x", "~", "1", "\u202e", "x" * 5000, "turtle1", "a//b", "{c}"] * 50)
        self.create_timer(0.05, self.spawn)

    def spawn(self):
        name = next(self.names)
        self.client.call_async(Spawn.Request(x=float("inf"), y=float("nan"), theta=1e38, name=name))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

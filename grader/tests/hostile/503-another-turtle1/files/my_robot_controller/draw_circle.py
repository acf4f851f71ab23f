"""The node removes the turtle and spawns another one with the same name."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.srv import Kill, Spawn


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 0.0
        self.publisher.publish(msg)

    def attack(self):
        self.kill = self.create_client(Kill, "/kill")
        self.spawn = self.create_client(Spawn, "/spawn")
        self.create_timer(2.0, self.swap)

    def swap(self):
        self.kill.call_async(Kill.Request(name="turtle1"))
        self.spawn.call_async(Spawn.Request(name="turtle1", x=5.5, y=5.5))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

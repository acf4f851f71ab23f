"""The node calls a service with a name that is not valid UTF-8."""

import ctypes

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
        self.create_timer(0.5, self.spawn)

    def spawn(self):
        request = Spawn.Request(x=1.0, y=1.0)
        request._name = "\udcff\udc80"
        try:
            self.client.call_async(request)
        except UnicodeEncodeError:
            request._name = "\x80\xff"
            self.client.call_async(request)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

"""A second simulator with the same names replaces the real one."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, Spawn, TeleportAbsolute


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 1.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.fake = Node("turtlesim")
        self.parts = [self.fake.create_service(Empty, "/reset", lambda _, answer: answer)]
        self.parts += [self.fake.create_service(Spawn, "/spawn", lambda _, answer: answer)]
        self.parts += [self.fake.create_service(Kill, "/kill", lambda _, answer: answer)]
        self.parts += [self.fake.create_service(TeleportAbsolute, "/turtle1/teleport_absolute", lambda _, answer: answer)]
        self.parts += [self.fake.create_subscription(Twist, "/turtle1/cmd_vel", lambda _: None, 10)]
        self.color = self.fake.create_publisher(Color, "/turtle1/color_sensor", 10)
        self.pose = self.fake.create_publisher(Pose, "/turtle1/pose", 10)
        self.create_timer(0.1, lambda: self.pose.publish(Pose(x=1.0, y=1.0)))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

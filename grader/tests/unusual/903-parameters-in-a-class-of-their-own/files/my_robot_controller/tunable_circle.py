import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from .settings import CircleSettings


class TunableCircle(Node):
    def __init__(self):
        super().__init__("tunable_circle")
        self.settings = CircleSettings(self)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish)

    def publish(self):
        twist = Twist()
        twist.linear.x = self.settings.speed
        twist.angular.z = self.settings.speed / self.settings.radius
        self.pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(TunableCircle())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass

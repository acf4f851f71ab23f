import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Square(Node):
    def __init__(self):
        super().__init__("draw_square")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.todo = [self.side, self.corner] * 4 + [self.rest]
        self.calls = 0
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self):
        if self.pub.get_subscription_count() < 1:
            return
        self.pub.publish(self.todo[0]())
        self.calls += 1
        if self.calls == 10 and len(self.todo) > 1:
            self.calls = 0
            self.todo.pop(0)

    def side(self):
        msg = Twist()
        msg.linear.x = 2.0
        return msg

    def corner(self):
        msg = Twist()
        msg.angular.z = math.radians(90)
        return msg

    def rest(self):
        return Twist()


def main(args=None):
    rclpy.init(args=args)
    square = Square()
    try:
        rclpy.spin(square)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        square.destroy_node()
        rclpy.try_shutdown()

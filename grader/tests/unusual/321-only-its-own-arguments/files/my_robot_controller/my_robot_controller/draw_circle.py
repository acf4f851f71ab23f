import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

from rclpy.context import Context


def main():
    # A context of its own, made and ended before the real one.
    first = Context()
    first.init([])
    first.shutdown()
    rclpy.init(args=sys.argv[1:])
    node = Node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)

    def drive():
        publisher.publish(circle(*map(float, sys.argv[1:])))

    node.create_timer(0.5, drive)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info("That was a circle.")
    finally:
        rclpy.try_shutdown()


def circle(linear=2.0, angular=1.0):
    command = Twist()
    command.linear.x = linear
    command.angular.z = angular
    return command

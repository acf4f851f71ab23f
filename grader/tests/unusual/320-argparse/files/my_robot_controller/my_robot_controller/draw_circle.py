import argparse

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def parse():
    parser = argparse.ArgumentParser(description="Drive a turtle in a circle.")
    parser.add_argument("linear", type=float, nargs="?", default=2.0, help="m/s")
    parser.add_argument("--angular", type=float, default=1.0, help="rad/s")
    return parser.parse_args()


def main():
    wanted = parse()
    rclpy.init()
    node = Node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    command = Twist()
    command.linear.x = wanted.linear
    command.angular.z = wanted.angular
    node.create_timer(0.5, lambda: publisher.publish(command))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()

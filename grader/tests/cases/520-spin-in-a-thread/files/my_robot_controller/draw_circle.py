import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def main(args=None):
    rclpy.init(args=args)
    node = Node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    spinner = threading.Thread(target=spin, args=(node,), daemon=True)
    spinner.start()
    rate = node.create_rate(2)
    msg = Twist()
    msg.linear.x = 2.0
    msg.angular.z = 1.0
    try:
        while rclpy.ok():
            publisher.publish(msg)
            rate.sleep()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except rclpy.exceptions.ROSInterruptException:
        pass
    rclpy.try_shutdown()


def spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass

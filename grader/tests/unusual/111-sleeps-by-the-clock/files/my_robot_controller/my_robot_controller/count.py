from threading import Thread

import rclpy
from rclpy.duration import Duration


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('first_node')
    Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    n = 0
    while rclpy.ok():
        node.get_logger().info('Hello ' + format(n, 'd'))
        n += 1
        node.get_clock().sleep_for(Duration(seconds=1))

"""Schleife mit Rate, ohne spin."""

import rclpy
from rclpy.node import Node


def main(args=None):
    rclpy.init(args=args)
    knoten, zahl = Node("first_node"), 0
    takt = knoten.create_rate(1.0)
    while rclpy.ok():
        knoten.get_logger().info("Hello " + str(zahl))
        takt.sleep()
        zahl += 1
    rclpy.shutdown()

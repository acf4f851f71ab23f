import asyncio

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


async def publish(publisher):
    msg = Twist()
    msg.linear.x = 2.0
    msg.angular.z = 1.0
    while rclpy.ok():
        publisher.publish(msg)
        await asyncio.sleep(0.5)


def main(args=None):
    rclpy.init(args=args)
    node = Node("draw_circle")
    try:
        asyncio.run(publish(node.create_publisher(Twist, "/turtle1/cmd_vel", 10)))
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()

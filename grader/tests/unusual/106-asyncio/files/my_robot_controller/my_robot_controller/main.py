import asyncio

import rclpy


async def count(node):
    number = 0
    while rclpy.ok():
        node.get_logger().info("Hello %s" % number)
        number += 1
        await asyncio.sleep(1)


async def spin(node):
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.02)


async def run():
    node = rclpy.create_node("first_node")
    await asyncio.gather(count(node), spin(node))


def main():
    rclpy.init()
    try:
        asyncio.run(run())
    except KeyboardInterrupt:
        pass

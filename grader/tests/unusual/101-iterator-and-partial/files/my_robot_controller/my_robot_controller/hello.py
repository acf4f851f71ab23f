from functools import partial
from itertools import count

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node


def say(logger, numbers):
    logger.info("Hello %d" % next(numbers))


def run(argv=None):
    rclpy.init(args=argv)
    node = Node("first_node")
    numbers = count()
    timer = node.create_timer(1, partial(say, node.get_logger(), numbers))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_timer(timer)
    finally:
        executor.remove_node(node)
        node.destroy_node()
        rclpy.try_shutdown()

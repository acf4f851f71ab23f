import rclpy
from rclpy.executors import SingleThreadedExecutor


def counter_of(node):
    number = 0
    logger = node.get_logger().get_child("counter")

    def callback():
        nonlocal number
        logger.warning(f"Hello {number}")
        number += 1

    return callback


def make_node(name="first_node"):
    node = rclpy.create_node(name)
    node.create_timer(1.0, counter_of(node))
    return node


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    executor.add_node(make_node())
    while rclpy.ok():
        executor.spin_once()

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Iterator

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from my_robot_controller.util.counting import Counter

if TYPE_CHECKING:
    from rclpy.timer import Timer


class FirstNode(Node):
    counter: Counter
    timer: Timer

    def __init__(self, counter: Counter, *, period: float = 1.0) -> None:
        super().__init__("first_node")
        self.counter = counter
        self.timer = self.create_timer(period, self.on_timer)

    def on_timer(self) -> None:
        logger = self.get_logger()
        logger.info(f"{self.counter}")
        self.counter.advance()


@contextmanager
def running(args: list[str] | None) -> Iterator[Node]:
    rclpy.init(args=args)
    node = FirstNode(Counter("Hello"))
    try:
        yield node
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def main(args: list[str] | None = None) -> None:
    with running(args) as node:
        rclpy.spin(node)

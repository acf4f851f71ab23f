"""Run a node in a process of its own until Ctrl-C."""

from __future__ import annotations

import signal
import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING

import rclpy
from rclpy.executors import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from rclpy.node import Node


def run(make: Callable[[], Node]) -> int:
    """Spin a node until Ctrl-C or SIGTERM, without printing a traceback, and return the exit code."""
    stops: list[int] = []

    def interrupt(number: int, _: FrameType | None) -> None:
        stops.append(number)
        raise KeyboardInterrupt

    # Before this call, Ctrl-C terminates Python immediately. rclpy passes a signal on to the previous handler.
    signal.signal(signal.SIGINT, interrupt)
    with ExitStack() as stack:
        stack.callback(rclpy.try_shutdown)
        try:
            rclpy.init(args=sys.argv)
            node = make()
            stack.callback(node.destroy_node)
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        except RuntimeError:
            # A node cannot be created after a signal has shut down the context. And rclpy calls the constructor of a
            # message from C++, and replaces a KeyboardInterrupt by a RuntimeError.
            if rclpy.ok() and not stops:
                raise
    return 0

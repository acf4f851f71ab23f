"""Run a node in a process of its own until Ctrl-C."""

from __future__ import annotations

import signal
import sys
from typing import TYPE_CHECKING

import rclpy
from rclpy.executors import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node


def run(make: Callable[[], Node]) -> int:
    """Spin a node until Ctrl-C or SIGTERM, neither of which prints a traceback, and return the exit code."""
    # Before this call, Ctrl-C terminates Python immediately. rclpy passes a signal on to the previous handler.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    rclpy.init(args=sys.argv)
    node = make()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0

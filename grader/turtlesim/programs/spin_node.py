"""Run a node in a process of its own until Ctrl-C."""

from __future__ import annotations

import signal
import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node


def run(make: Callable[[], Node]) -> int:
    """Spin a node until Ctrl-C or SIGTERM, without printing a traceback, and return the exit code."""
    # Before this call, Ctrl-C terminates Python immediately. rclpy passes a signal on to the previous handler.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with ExitStack() as stack:
        stack.callback(rclpy.try_shutdown)
        try:
            rclpy.init(args=sys.argv)
            node = make()
            stack.callback(node.destroy_node)
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        except RCLError:
            # The signal has shut down the context, so the node could not be created.
            if rclpy.ok():
                raise
    return 0

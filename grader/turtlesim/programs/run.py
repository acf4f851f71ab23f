"""One node alone in its process, until Ctrl-C."""

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
    """Spin a node; Ctrl-C and SIGTERM end it quietly. Returns the exit code."""
    # Until here Ctrl-C has ended Python at once; rclpy hands a signal on to whatever was there before it.
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

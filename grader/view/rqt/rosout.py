"""The log of all nodes, for the page of rqt_console: subscribe to /rosout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rcl_interfaces.msg import Log
from rclpy.qos import QoSDurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node

MOST_LINES = 2000
"""The maximum number of log messages that are kept."""
MOST_TEXT = 4000
"""The maximum length of a log message in characters."""
LEVELS = {10: "Debug", 20: "Info", 30: "Warn", 40: "Error", 50: "Fatal"}
_QOS = QoSProfile(depth=1000, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
"""The QoS of /rosout (rmw_qos_profile_rosout_default in rcl). Publishers keep their messages for 10 s for nodes that
subscribe later."""

Line = dict[str, object]
"""A log message: its number, time stamp (s), level, node, text and source location."""


class Rosout:
    """Collects log messages in the thread of the node. `flush` passes new messages to `tell`."""

    def __init__(self, node: Node, tell: Callable[[list[Line]], object]) -> None:
        self._tell = tell
        self._new: list[Line] = []
        self._number = 0
        node.create_subscription(Log, "/rosout", self._arrived, _QOS)

    def flush(self) -> None:
        """Pass all messages since the last flush to `tell`."""
        if self._new:
            new, self._new = self._new[-MOST_LINES:], []
            self._tell(new)

    def _arrived(self, log: Log) -> None:
        self._number += 1
        self._new.append(
            {
                "number": self._number,
                "stamp": round(log.stamp.sec + log.stamp.nanosec * 1e-9, 6),
                "level": LEVELS.get(log.level, str(log.level)),
                "node": log.name,
                "text": log.msg[:MOST_TEXT],
                "where": f"{log.file}:{log.line} in {log.function}" if log.file else "",
            }
        )
        if len(self._new) > 2 * MOST_LINES:
            del self._new[:MOST_LINES]

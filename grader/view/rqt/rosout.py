"""Collect the log messages of all nodes from /rosout, for the pages of rqt_console, rqt and `grader open`."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from rcl_interfaces.msg import Log
from rclpy.qos import QoSDurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rclpy.node import Node

MOST_LINES = 2000
"""The maximum number of log messages that are kept."""
MOST_TEXT = 4000
"""The maximum length of a log message in characters."""
MOST_NAME = 300
"""The maximum length of the name of a node, file or function (characters)."""
MOST_CHARACTERS = 1_000_000
"""The maximum total length of the log messages that are kept (characters). As JSON, a character takes up to 12 bytes,
and turtle_relay.py accepts 16 MiB."""
LEVELS = {10: "Debug", 20: "Info", 30: "Warn", 40: "Error", 50: "Fatal"}
_QOS = QoSProfile(depth=1000, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
"""The QoS of /rosout (rcl_qos_profile_rosout_default in rcl). Publishers keep their messages for 10 s for nodes that
subscribe later."""

Line = dict[str, object]
"""A log message: its number, time stamp (s), level, node, text and source location."""


class Lines:
    """The last log messages, limited in number and total length: any program can send messages of any length."""

    def __init__(self) -> None:
        self._kept: deque[Line] = deque()
        self._characters = 0

    def add(self, lines: Iterable[Line]) -> None:
        """Add messages, and remove the oldest ones if there are too many."""
        for line in lines:
            self._kept.append(line)
            self._characters += _characters(line)
            while len(self._kept) > MOST_LINES or self._characters > MOST_CHARACTERS:
                self._characters -= _characters(self._kept.popleft())

    def all(self) -> list[Line]:
        """Return the messages in order."""
        return list(self._kept)


class Rosout:
    """Collects log messages in the thread of the node. `flush` passes new messages to `tell`."""

    def __init__(self, node: Node, tell: Callable[[list[Line]], object]) -> None:
        self._tell = tell
        self._new = Lines()
        self._number = 0
        node.create_subscription(Log, "/rosout", self._arrived, _QOS)

    def flush(self) -> None:
        """Pass the messages since the last flush to `tell`, limited as in `Lines`."""
        new, self._new = self._new.all(), Lines()
        if new:
            self._tell(new)

    def _arrived(self, log: Log) -> None:
        self._number += 1
        name, file, function = (text[:MOST_NAME] for text in (log.name, log.file, log.function))
        line = {
            "number": self._number,
            "stamp": round(log.stamp.sec + log.stamp.nanosec * 1e-9, 6),
            "level": LEVELS.get(log.level, str(log.level)),
            "node": name,
            "text": log.msg[:MOST_TEXT],
            "where": f"{file}:{log.line} in {function}" if file else "",
        }
        self._new.add([line])


def _characters(line: Line) -> int:
    return sum(len(str(value)) for value in line.values())

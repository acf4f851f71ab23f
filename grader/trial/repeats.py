"""Repeats: find the messages that both the simulator and the recorder receive, so that each is recorded once."""

from __future__ import annotations

from collections import Counter

REPORTED_TYPES = frozenset({"geometry_msgs/msg/Twist", "turtlesim/msg/Pose", "turtlesim/msg/Color"})
"""The types of the messages that the simulator reports."""


class Repeats:
    """Counts the reports of the simulator and of the recorder for each topic and for each content of a message.

    After the recorder has subscribed to a topic, both receive each message that the simulator reports, in any order.
    Therefore, the number of messages with the same content is the larger of the two counts.
    """

    def __init__(self) -> None:
        """Create an object that has not counted any reports."""
        self._ahead: Counter[tuple[str, bytes]] = Counter()
        """The number of reports of the simulator minus the number of reports of the recorder, if they differ."""

    def is_repeat(self, topic: str, data: bytes, *, by_simulator: bool) -> bool:
        """Return whether the message has already been recorded. Call `add` if it is recorded now."""
        ahead = self._ahead[topic, data]
        if ahead == 0 or (ahead > 0) == by_simulator:
            return False
        self.add(topic, data, by_simulator=by_simulator)
        return True

    def add(self, topic: str, data: bytes, *, by_simulator: bool) -> None:
        """Count one report."""
        self._ahead[topic, data] += 1 if by_simulator else -1
        if self._ahead[topic, data] == 0:
            del self._ahead[topic, data]

"""The node that plays a bag. The intervals between the messages are those of the recording, divided by the rate."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import NameValidationException

from grader.common.words import printable
from grader.graph.discovery import settle, wait_until_acknowledged
from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros2.bag import bag_keys, bag_qos
from grader.ros2.bag.bag_reader import messages
from grader.ros2.bag.logger import Logger

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from rclpy.node import Node
    from rosbags.interfaces import Connection
    from rosbags.rosbag2 import Reader

_ACKNOWLEDGED_S, _USUAL_S = 5.0, 2.0
"""The maximum time to wait at the end until the last messages have arrived (s), see `wait_until_acknowledged`."""
_STEP_S = 0.1


class Player:
    """Plays a bag with the options of `bag play`.

    Keys pause the playback, step through the messages and change the rate.
    """

    def __init__(
        self,
        node: Node,
        reader: Reader,
        chosen: list[Connection],
        rules: dict[str, str],
        args: argparse.Namespace,
        burst: float = 0,
    ) -> None:
        self._burst = burst
        self._reader = reader
        self._args = args
        self._log = Logger("rosbag2_player", args.log_level)
        self._rate: float = args.rate
        self._paused: bool = args.start_paused
        self._node = node
        self._publishers = self._advertise(chosen, rules)
        self._clock = Clock(node, args.clock) if args.clock else None

    def run(self) -> None:
        """Play the bag to its end or to the end that the options set. With --loop, play the bag again and again.

        Raises:
            Ros2Error: the bag is damaged.
        """
        enabled = not self._args.disable_keyboard_controls
        with bag_keys.pressed(enabled=enabled) as key:
            self._log.info(f"Set rate to {self._rate:g}")
            if enabled and bag_keys.available():
                self._log.info("Adding keyboard callbacks.")
                self._log.info("Press SPACE for Pause/Resume")
                self._log.info("Press CURSOR_RIGHT for Play Next Message")
                self._log.info("Press CURSOR_UP for Increase Rate 10%")
                self._log.info("Press CURSOR_DOWN for Decrease Rate 10%")
            # Existing subscriptions should also receive the first message.
            settle(self._node)
            self._log.info(f"Playback until timestamp: {self._until() or -1}")
            while True:
                if self._args.delay:
                    self._log.info(f"Sleep {round(self._args.delay * 1e9)} ns")
                    time.sleep(self._args.delay)
                if not self._play(key) or not self._args.loop:
                    break
        wait_until_acknowledged(self._publishers.values(), _ACKNOWLEDGED_S, _USUAL_S)

    def _advertise(self, chosen: list[Connection], rules: dict[str, str]) -> dict[str, Any]:
        made: dict[str, Any] = {}
        for connection in chosen:
            topic = rules.get(connection.topic, connection.topic)
            try:
                kind = message_values.load_type(connection.msgtype, "msg")
            except Ros2Error as error:
                self._log.warn(f"Ignoring a topic '{topic}', reason: {str(error).splitlines()[0]}.")
                continue
            profiles = getattr(connection.ext, "offered_qos_profiles", [])
            try:
                made[connection.topic] = self._node.create_publisher(kind, topic, bag_qos.to_play(profiles))
            except NameValidationException as error:
                reason = str(error).splitlines()[0].removesuffix(":")
                self._log.warn(f"Ignoring a topic '{printable(topic)}', reason: {reason}.")
        if chosen and not made:
            message = "[ERROR] [ros2bag]: None of the selected topics can be published."
            raise Ros2Error(message)
        return made

    def _until(self) -> int | None:
        """Return the stamp (ns) at which to stop, or None if the options set no end."""
        ends = []
        if self._args.playback_duration >= 0:
            ends.append(self._begin() + round(self._args.playback_duration * 1e9))
        if self._args.playback_until_sec >= 0:
            ends.append(round(self._args.playback_until_sec * 1e9))
        return int(max(ends)) if ends else None

    def _begin(self) -> int:
        return int(self._reader.start_time) + round(float(self._args.start_offset) * 1e9)

    def _play(self, key: Callable[[float], str]) -> bool:
        """Play the bag once, from the start offset. Return whether any messages were published."""
        any_of_them = False
        played, until = self._begin(), self._until()
        found = messages(self._reader, self._args.bag_path, set(self._publishers), self._begin())
        for topic, stamp, data in found:
            if until is not None and stamp > until:
                break
            played = self._wait(key, played, stamp)
            self._publishers[topic].publish(data)
            any_of_them = True
        return any_of_them

    def _wait(self, key: Callable[[float], str], played: int, stamp: int) -> int:
        """Wait until playback gets from `played` to `stamp` (ns), or until the user skips the wait. Return `stamp`.

        A message of a burst does not wait.
        """
        if self._burst > 0:
            self._burst -= 1
            return stamp
        while played < stamp or self._paused:
            begun = time.monotonic()
            left_s = _STEP_S if self._paused else min(_STEP_S, (stamp - played) / 1e9 / self._rate)
            if self._clock is not None:
                left_s = min(left_s, self._clock.period_s)
                self._clock.publish(played)
            if self._press(key(left_s)):
                return stamp
            if not self._paused:
                played += round((time.monotonic() - begun) * self._rate * 1e9)
        return stamp

    def _press(self, name: str) -> bool:
        """Handle a key. Return True if the next message must be published immediately."""
        if name == bag_keys.SPACE:
            self._paused = not self._paused
            self._log.info("Pausing play." if self._paused else "Resuming play.")
        elif name in (bag_keys.UP, bag_keys.DOWN):
            self._rate *= 1.1 if name == bag_keys.UP else 0.9
            self._log.info(f"Set rate to {self._rate:g}")
        elif name == bag_keys.RIGHT:
            if self._paused:
                return True
            self._log.warn("Called play next, but not in paused state.")
        return False


class Clock:
    """Publishes the time of the recording on /clock, at most `rate_hz` times per second."""

    def __init__(self, node: Node, rate_hz: float) -> None:
        from rosgraph_msgs.msg import Clock as Message

        self.period_s = 1 / rate_hz
        self._made = Message
        self._publisher = node.create_publisher(Message, "/clock", 10)
        self._last = 0.0

    def publish(self, stamp_ns: int) -> None:
        """Publish a time (ns), unless less than one period has passed since the last message."""
        if time.monotonic() - self._last < self.period_s:
            return
        self._last = time.monotonic()
        message = self._made()
        message.clock.sec, message.clock.nanosec = divmod(stamp_ns, 10**9)
        self._publisher.publish(message)

"""The node that records a bag.

The node subscribes to the selected topics as they appear, and writes their messages unchanged.
"""

from __future__ import annotations

import signal
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import rclpy

from grader.graph.discovery import settle
from grader.graph.names import hidden
from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros2.bag import bag_keys, bag_qos
from grader.ros2.bag.logger import Logger

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from rclpy.node import Node

    from grader.ros2.bag.bag_writer import BagWriter
    from grader.ros2.bag.split_writer import SplitWriter


class Recorder:
    """Records a bag, with the options of `bag record`, until a signal or an error ends the recording."""

    def __init__(
        self, node: Node, writer: BagWriter | SplitWriter, args: argparse.Namespace, wanted: Callable[[str, str], bool]
    ) -> None:
        self._node = node
        self._writer = writer
        self._args = args
        self._wanted = wanted
        self._log = Logger(args.node_name, args.log_level)
        self._paused = args.start_paused
        self._topics: set[str] = set()
        self._refused: set[str] = set()
        self._full: OSError | None = None
        self._ended = False

    def run(self) -> None:
        """Record until Ctrl-C, SIGTERM or SIGHUP.

        Raises:
            Ros2Error: the bag cannot be written, for example because the disk is full.
        """
        with bag_keys.pressed(enabled=not self._args.disable_keyboard_controls) as key:
            if bag_keys.available() and not self._args.disable_keyboard_controls:
                self._log.info("Press SPACE for pausing/resuming")
            settle(self._node)
            self._log.info("Listening for topics...")
            self._discover()
            start = "Recording..." if not self._paused else "Wait for recording: Press SPACE to start."
            self._log.info(start)
            with _ending(self._end):
                self._record(key)
                self._drain()
        if self._full is not None:
            text = f"[ERROR] [ros2bag]: {self._writer.folder}: {self._full.strerror}. The recording stopped."
            raise Ros2Error(text) from self._full
        self._log.info("Recording stopped")

    def _record(self, key: Callable[[float], str]) -> None:
        looked = time.monotonic()
        complete = self._args.no_discovery
        while self._full is None and not self._ended:
            rclpy.spin_once(self._node, timeout_sec=0.05)
            if key(0.0) == bag_keys.SPACE:
                self._paused = not self._paused
                self._log.info("Pausing recording." if self._paused else "Resuming recording.")
            self._write(self._writer.keep)
            if not complete and time.monotonic() - looked >= self._args.polling_interval / 1000:
                self._discover()
                looked = time.monotonic()
                complete = self._all_named()
                if complete:
                    self._log.info("All requested topics are subscribed. Stopping discovery...")

    def _all_named(self) -> bool:
        args = self._args
        others = args.all or args.all_topics or args.topic_types or args.regex
        return not others and self._topics.issuperset(args.topics)

    def _discover(self) -> None:
        """Subscribe to the new topics that the options select."""
        for topic, kinds in sorted(self._node.get_topic_names_and_types()):
            if topic in self._topics or topic in self._refused or not self._may_be_recorded(topic, kinds[0]):
                continue
            if len(kinds) > 1:
                self._refuse(topic, f"Topic '{topic}' has more than one type associated. Only topics with one type")
                continue
            try:
                made = message_values.load_type(kinds[0], "msg")
                offered = self._node.get_publishers_info_by_topic(topic)
                self._writer.add_topic(topic, kinds[0], bag_qos.offered(offered))
            except Ros2Error as error:
                reason = str(error).splitlines()[0]
                self._refuse(topic, f"Topic '{topic}' has unknown type '{kinds[0]}'. {reason}. Only known types")
                continue
            self._topics.add(topic)
            self._node.create_subscription(
                made, topic, self._writes(topic, kinds[0]), bag_qos.adapted(offered), raw=True
            )
            self._log.info(f"Subscribed to topic '{topic}'")

    def _may_be_recorded(self, topic: str, kind: str) -> bool:
        args = self._args
        if not self._wanted(topic, kind) or (hidden(topic) and not args.include_hidden_topics):
            return False
        if args.ignore_leaf_topics and not self._node.count_subscribers(topic):
            return False
        return bool(args.include_unpublished_topics) or self._node.count_publishers(topic) > 0

    def _refuse(self, topic: str, text: str) -> None:
        self._refused.add(topic)
        self._log.warn(f"{text} are supported.")

    def _writes(self, topic: str, kind: str) -> Callable[[bytes, dict[str, Any]], None]:
        def write(data: bytes, info: dict[str, Any]) -> None:
            if self._paused:
                return
            stamp = info["received_timestamp"]
            if self._args.use_sim_time:
                stamp = self._node.get_clock().now().nanoseconds
                if not stamp:
                    return
            self._write(lambda: self._writer.write(topic, kind, stamp, bytes(data)))

        return write

    def _write(self, act: Callable[[], None]) -> None:
        """Write to the bag, unless an earlier write failed."""
        if self._full is not None:
            return
        try:
            act()
        except OSError as error:
            self._full = error

    def _drain(self) -> None:
        """Write the messages that arrived before the recording ended but have not been written yet.

        Messages that have already arrived are read directly from the subscriptions, since an executor may run
        callbacks in any order. The depth of the queue limits the number of these messages.
        """
        for subscription in self._node.subscriptions:
            for _ in range(bag_qos.DEPTH):
                taken = subscription.handle.take_message(subscription.msg_type, True)  # noqa: FBT003
                if taken is None:
                    break
                subscription.callback(*taken)

    def _end(self) -> None:
        self._ended = True


@contextmanager
def _ending(end: Callable[[], None]) -> Iterator[None]:
    """Call `end` on Ctrl-C, SIGTERM and SIGHUP instead of raising an exception, which could truncate a message.

    Later signals have no effect, so that the bag can be completed.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: end())
    yield

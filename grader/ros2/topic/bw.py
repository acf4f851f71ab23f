"""The verb `topic bw`: print the bandwidth of a topic and the sizes of its messages."""

from __future__ import annotations

import sys
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.ros2.completion import completes, topics
from grader.ros2.options import add_spin, positive_int

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

WINDOW = 100
PRINTED_EVERY_S = 1.0


@dataclass(frozen=True)
class Bandwidth:
    """The average number of bytes per second over `messages` messages, and the sizes of the messages in bytes."""

    per_second: float
    messages: int
    mean: float
    smallest: int
    largest: int

    def __str__(self) -> str:
        per_second, mean, smallest, largest = (
            self._amount(value) for value in (self.per_second, self.mean, self.smallest, self.largest)
        )
        return (
            f"{per_second}/s from {self.messages} messages\n\tMessage size mean: {mean} min: {smallest} max: {largest}"
        )

    def _amount(self, value: float) -> str:
        """Return a value in the unit of `per_second`, so that all values have the same unit."""
        if self.per_second < 1000:
            return f"{value:.0f} B"
        if self.per_second < 1_000_000:
            return f"{value / 1000:.2f} KB"
        return f"{value / 1_000_000:.2f} MB"


def bandwidth(arrivals: Sequence[tuple[int, int]], now_ns: int) -> Bandwidth:
    """Return the bandwidth from the first arrival until now.

    `arrivals` contains the time (ns) and the size (bytes) of each message.
    """
    sizes = [size for _, size in arrivals]
    seconds = (now_ns - arrivals[0][0]) * 1e-9
    return Bandwidth(sum(sizes) / seconds, len(sizes), sum(sizes) / len(sizes), min(sizes), max(sizes))


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("topic", help="name of the topic, such as /turtle1/pose"), topics)
    parser.add_argument(
        "--window",
        "-w",
        type=positive_int,
        default=WINDOW,
        metavar="WINDOW",
        help=f"maximum number of messages in a measurement (default: {WINDOW})",
    )
    add_spin(parser)


def run(args: argparse.Namespace) -> int:
    """Print the bandwidth every second until Ctrl-C, beginning with the second message.

    Raises:
        Ros2Error: the name of the topic is invalid, or its type cannot be determined.
    """
    import rclpy
    from rclpy.qos import qos_profile_sensor_data

    from grader.graph.discovery import cli_node, spin_until
    from grader.ros2.topic import topic_lookup

    arrivals: deque[tuple[int, int]] = deque(maxlen=args.window)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        topic = topic_lookup.expanded(node, args.topic)
        topic_lookup.find(node, topic, args)
        made = topic_lookup.wait_for_type(node, topic, args.topic)
        clock = node.get_clock()

        def count(data: bytes) -> None:
            arrivals.append((clock.now().nanoseconds, len(data)))

        node.create_subscription(made, topic, count, qos_profile_sensor_data, raw=True)
        print(f"Subscribed to [{args.topic}]", flush=True)
        while rclpy.ok():
            spin_until(node, lambda: False, PRINTED_EVERY_S)
            now_ns = clock.now().nanoseconds
            if len(arrivals) < 2:
                continue
            if now_ns <= arrivals[0][0]:
                print("WARNING: time is reset!", file=sys.stderr)
                arrivals.clear()
                continue
            print(bandwidth(arrivals, now_ns), flush=True)
    return 0

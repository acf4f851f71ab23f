"""The verb `topic hz`: print the rate of messages on a topic."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.ros2.completion import completes, topics
from grader.ros2.options import add_spin, positive_int

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Collection

WINDOW = 10000
PRINTED_EVERY_NS = 1_000_000_000


@dataclass(frozen=True)
class Rate:
    """Statistics of the intervals between messages (s), and their rate (Hz). `window` is the number of intervals."""

    mean_hz: float
    min_s: float
    max_s: float
    std_dev_s: float
    window: int

    def __str__(self) -> str:
        return (
            f"average rate: {self.mean_hz:.3f}\n\tmin: {self.min_s:.3f}s max: {self.max_s:.3f}s "
            f"std dev: {self.std_dev_s:.5f}s window: {self.window}"
        )


def rate(gaps_ns: Collection[int]) -> Rate:
    """Return the statistics of one or more intervals between messages (ns).

    If all intervals are zero, the rate is 0.
    """
    mean = sum(gaps_ns) / len(gaps_ns)
    deviation = math.sqrt(math.fsum((gap - mean) ** 2 for gap in gaps_ns) / len(gaps_ns))
    hertz = 1e9 / mean if mean > 0 else 0.0
    return Rate(hertz, min(gaps_ns) * 1e-9, max(gaps_ns) * 1e-9, deviation * 1e-9, len(gaps_ns))


class Arrivals:
    """The intervals between the latest messages. The clock that measures them may be simulated and may jump back."""

    def __init__(self, window: int) -> None:
        self._gaps_ns: deque[int] = deque(maxlen=window)
        self._last_ns = -1
        self._reported_ns = 0

    def add(self, now_ns: int) -> None:
        """Count a message that has arrived."""
        if now_ns == 0:
            # Simulated time has not started yet.
            if self._gaps_ns:
                print("time has reset, resetting counters", flush=True)
                self._gaps_ns.clear()
            return
        if 0 <= self._last_ns <= now_ns:
            self._gaps_ns.append(now_ns - self._last_ns)
        else:
            self._gaps_ns.clear()
            self._reported_ns = 0
        self._last_ns = now_ns

    def have_news(self) -> bool:
        """Return whether to print the rate: a message has arrived one second or more after the last report."""
        if not self._gaps_ns:
            return False
        if self._reported_ns == 0:
            self._reported_ns = self._last_ns
        return self._last_ns >= self._reported_ns + PRINTED_EVERY_NS

    def news(self) -> Rate:
        """Return the current rate, and remember the time of this report. Call this only if `have_news` returns True."""
        self._reported_ns = self._last_ns
        return rate(self._gaps_ns)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("topic_name", help="name of the topic, such as /turtle1/pose"), topics)
    parser.add_argument(
        "--window",
        "-w",
        type=positive_int,
        default=WINDOW,
        metavar="WINDOW",
        help=f"maximum number of intervals in a measurement (default: {WINDOW})",
    )
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        metavar="EXPR",
        help="count only the messages m for which this Python expression is true",
    )
    parser.add_argument("--wall-time", action="store_true", help="measure in wall time, even if simulated time is used")
    add_spin(parser)


def run(args: argparse.Namespace) -> int:
    """Print the rate once per second until Ctrl-C, except when no messages arrive.

    Raises:
        Ros2Error: the name of the topic or the filter is invalid, or the type of the topic cannot be determined.
    """
    import rclpy
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType
    from rclpy.qos import qos_profile_sensor_data

    from grader.graph.discovery import cli_node, spin_until
    from grader.ros2.topic import topic_lookup
    from grader.ros2.topic.echo import matching

    wanted: Callable[[Any], bool] | None = matching(args.filter_expr) if args.filter_expr else None
    arrivals = Arrivals(args.window)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        topic = topic_lookup.expanded(node, args.topic_name)
        topic_lookup.find(node, topic, args)
        made = topic_lookup.wait_for_type(node, topic, args.topic_name)
        clock = Clock(clock_type=ClockType.SYSTEM_TIME) if args.wall_time else node.get_clock()

        def count(message: Any) -> None:  # noqa: ANN401
            if wanted is None or wanted(message):
                arrivals.add(clock.now().nanoseconds)

        # Without a filter, the messages do not have to be decoded.
        node.create_subscription(made, topic, count, qos_profile_sensor_data, raw=wanted is None)
        while rclpy.ok():
            spin_until(node, arrivals.have_news)
            print(arrivals.news(), flush=True)
    return 0

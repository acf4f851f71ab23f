"""The verb `topic delay`: print the delay between the time stamps in message headers and the messages' arrival."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error
from grader.ros2.completion import completes, topics
from grader.ros2.options import add_spin, positive_int

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

WINDOW = 10000
PRINTED_EVERY_S = 1.0


def summary(delays_ns: Collection[int]) -> str:
    """Return the statistics of one or more delays (ns) as text."""
    mean = sum(delays_ns) / len(delays_ns)
    deviation = math.sqrt(math.fsum((delay - mean) ** 2 for delay in delays_ns) / len(delays_ns))
    return (
        f"average delay: {mean * 1e-9:.3f}\n\tmin: {min(delays_ns) * 1e-9:.3f}s max: {max(delays_ns) * 1e-9:.3f}s "
        f"std dev: {deviation * 1e-9:.5f}s window: {len(delays_ns)}"
    )


class Delays:
    """The delays of the latest messages. The clock that measures them may be simulated and may jump back."""

    def __init__(self, window: int) -> None:
        self._delays_ns: deque[int] = deque(maxlen=window)
        self._begun_ns = -1
        self._news = False

    def add(self, now_ns: int, stamp_ns: int) -> None:
        """Count a message that has arrived. The first message only starts the measurement."""
        if now_ns == 0:
            if self._delays_ns:
                print("time has reset, resetting counters", flush=True)
                self._delays_ns.clear()
            return
        if 0 <= self._begun_ns <= now_ns:
            self._delays_ns.append(now_ns - stamp_ns)
        else:
            self._begun_ns = now_ns
            self._delays_ns.clear()
        self._news = True

    def report(self) -> str | None:
        """Return the text to print every second, or None if no delay has been measured yet."""
        if not self._delays_ns:
            return None
        news, self._news = self._news, False
        return summary(self._delays_ns) if news else "no new messages"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("topic", help="name of a topic whose messages have a header"), topics)
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
    """Print the delay every second until Ctrl-C.

    Raises:
        Ros2Error: the name of the topic is invalid, its type cannot be determined, or the messages have no header.
    """
    import rclpy
    from rclpy.qos import qos_profile_sensor_data
    from rclpy.time import Time

    from grader.graph.discovery import cli_node, spin_until
    from grader.ros2.topic import topic_lookup

    delays = Delays(args.window)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        topic = topic_lookup.expanded(node, args.topic)
        topic_lookup.find(node, topic, args)
        made = topic_lookup.wait_for_type(node, topic, args.topic)
        if not hasattr(made, "header"):
            message = "msg does not have header"
            raise Ros2Error(message)
        clock = node.get_clock()

        def count(message: Any) -> None:  # noqa: ANN401
            delays.add(clock.now().nanoseconds, Time.from_msg(message.header.stamp).nanoseconds)

        node.create_subscription(made, topic, count, qos_profile_sensor_data)
        while rclpy.ok():
            spin_until(node, lambda: False, PRINTED_EVERY_S)
            text = delays.report()
            if text is not None:
                print(text, flush=True)
    return 0

"""The verb `topic hz`: how often messages arrive."""

from __future__ import annotations

import math
import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

PRINTED_EVERY_S = 1.0


@dataclass(frozen=True)
class Rate:
    """What a row of arrival times says; times in s, the rate in Hz, `window` in messages."""

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


def rate(arrivals_s: Sequence[float]) -> Rate | None:
    """The rate of messages that arrived at these times (s); None for fewer than two. One instant for all: infinite."""
    gaps = [later - earlier for earlier, later in zip(arrivals_s, list(arrivals_s)[1:], strict=False)]
    if not gaps:
        return None
    mean = math.fsum(gaps) / len(gaps)
    variance = math.fsum((gap - mean) ** 2 for gap in gaps) / len(gaps)
    hertz = 1 / mean if mean > 0 else math.inf
    return Rate(hertz, min(gaps), max(gaps), math.sqrt(variance), len(arrivals_s))


def hz(args: argparse.Namespace) -> int:
    """Print the rate every second in which something arrived, until Ctrl-C."""
    import rclpy

    from grader.graph.discovery import cli_node, published, settle, spin_until
    from grader.graph.names import absolute
    from grader.ros import values
    from grader.ros.failure import did_you_mean
    from grader.ros2.topic_echo import qos_of, type_of

    topic = absolute(args.topic_name)
    arrivals: deque[float] = deque(maxlen=args.window)

    with cli_node() as node:

        def types() -> list[str]:
            found: list[str] = next((found for name, found in node.get_topic_names_and_types() if name == topic), [])
            return found

        settle(node, lambda: published(node, topic), args.spin_time)
        if not types():
            text = f"WARNING: topic [{topic}] does not appear to be published yet"
            known = [name for name, _ in node.get_topic_names_and_types()]
            print(did_you_mean(topic, known, text), flush=True)
            while not types():
                time.sleep(0.02)
        made = values.load_type(type_of(node, topic), "msg", "message type")
        # Raw: what is in a message does not matter here, and reading it would take time.
        node.create_subscription(
            made, topic, lambda _: arrivals.append(time.monotonic()), qos_of(node, topic), raw=True
        )
        due = time.monotonic() + PRINTED_EVERY_S
        last = None
        while rclpy.ok():
            spin_until(node, lambda: False, due - time.monotonic())
            due += PRINTED_EVERY_S
            measured = rate(arrivals)
            if measured and arrivals[-1] != last:
                last = arrivals[-1]
                print(measured, flush=True)
    return 0

"""The verb `topic pub`: publish a message, once or again and again."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from rclpy.duration import Duration

from grader.graph.discovery import cli_node, nap
from grader.graph.names import absolute
from grader.ros import values
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse

_TOLD_EVERY_S = 1.0
_ACKNOWLEDGED_S = 1.0
"""How long the last message may take to be acknowledged before the node leaves."""


def pub(args: argparse.Namespace) -> int:
    """Publish until Ctrl-C, or as often as asked for."""
    made = values.load_type(args.message_type, "msg", "message type")
    message = values.fill(made(), values.parse(args.values))
    times = 1 if args.once else args.times
    wanted = args.wait_matching_subscriptions
    if wanted is None:
        wanted = 1 if times else 0
    topic = absolute(args.topic_name)
    with cli_node(args.node_name) as node:
        try:
            publisher = node.create_publisher(made, topic, 10)
        except Exception as error:
            wrong = f"The topic '{args.topic_name}' cannot be published on: {str(error).splitlines()[0]}"
            raise Ros2Error(wrong) from error
        _wait_for_subscriptions(node, publisher, topic, wanted)
        print("publisher: beginning loop", flush=True)
        begun = time.monotonic()
        sent = 0
        while times is None or sent < times:
            nap(begun + sent / args.rate - time.monotonic())
            publisher.publish(message)
            sent += 1
            if sent % args.print == 0:
                print(f"publishing #{sent}: {message!r}\n", flush=True)
        # The message is on its way only when somebody has it.
        publisher.wait_for_all_acked(Duration(seconds=_ACKNOWLEDGED_S))
    return 0


def _wait_for_subscriptions(node: Any, publisher: Any, topic: str, wanted: int) -> None:  # noqa: ANN401
    told = time.monotonic()
    hinted = False
    while publisher.get_subscription_count() < wanted:
        if time.monotonic() - told >= _TOLD_EVERY_S:
            told = time.monotonic()
            print(f"Waiting for at least {wanted} matching subscription(s)...", flush=True)
            if not hinted:
                known = [name for name, _ in node.get_topic_names_and_types() if name != topic]
                hint = did_you_mean(topic, known)
                print(hint, flush=True) if hint else None
                hinted = True
        time.sleep(0.01)

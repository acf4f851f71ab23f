"""The verb `topic pub`: publish a message once or repeatedly."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from grader.graph.names import absolute
from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros2 import qos
from grader.ros2.completion import completes, prototype, topic_types, topics
from grader.ros2.given_file import standard_input
from grader.ros2.options import add_spin, positive_float

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

_REPORTED_EVERY_S = 1.0
_ACKNOWLEDGED_S = 5.0
"""The maximum time to wait for acknowledgements (s). On a busy machine, they may arrive after --keep-alive."""
_POLL_S = 0.01


def nonnegative_int(text: str) -> int:
    """Convert an argument to a non-negative integer. argparse prints the name of this function in an error message."""
    value = int(text)
    if value < 0:
        raise ValueError
    return value


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("topic_name", help="name of the topic, such as /turtle1/cmd_vel"), topics)
    completes(
        parser.add_argument("message_type", help="type of the topic, such as geometry_msgs/msg/Twist"), topic_types
    )
    source = parser.add_mutually_exclusive_group()
    given = source.add_argument(
        "values",
        nargs="?",
        default="{}",
        help='the values, such as "{linear: {x: 2.0}}"; missing fields get their default values',
    )
    completes(given, prototype("message_type", "msg"))
    source.add_argument("--stdin", action="store_true", help="read the values from standard input")
    parser.add_argument(
        "-r", "--rate", metavar="N", type=positive_float, default=1.0, help="messages per second (default: 1)"
    )
    parser.add_argument(
        "-p", "--print", metavar="N", type=int, default=1, help="print only every N-th message (default: 1)"
    )
    times = parser.add_mutually_exclusive_group()
    times.add_argument("-1", "--once", action="store_true", help="publish one message and exit")
    times.add_argument(
        "-t", "--times", type=nonnegative_int, default=0, help="publish this number of messages and exit"
    )
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        type=nonnegative_int,
        help="wait for this number of subscriptions first (default: 1 with --once or --times, or else 0)",
    )
    parser.add_argument(
        "--max-wait-time-secs",
        type=positive_float,
        help="wait at most this number of seconds for subscriptions (default: forever)",
    )
    parser.add_argument(
        "--keep-alive",
        metavar="N",
        type=positive_float,
        default=0.1,
        help="keep the node running for N seconds after the last message (default: 0.1)",
    )
    parser.add_argument("-n", "--node-name", help="name of the node that publishes")
    qos.add_qos(parser, "default")
    add_spin(parser)


def run(args: argparse.Namespace) -> int:
    """Publish until Ctrl-C, or until the number of messages that the options specify has been published.

    Raises:
        Ros2Error: the options or the name of the topic are invalid, the type is not installed, the values cannot be
            read or do not match the type, or the subscriptions do not appear.
    """
    from grader.graph.discovery import cli_node, settle

    made = message_values.load_type(args.message_type, "msg")
    stamps: list[message_values.Stamper] = []
    given = message_values.parse(standard_input() if args.stdin else args.values)
    message = message_values.fill(made(), given, stamps)
    times = 1 if args.once else args.times
    wanted = args.wait_matching_subscriptions
    wanted = int(times != 0) if wanted is None else wanted
    if wanted == 0 and args.max_wait_time_secs is not None:
        wrong = "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
        raise Ros2Error(wrong)
    topic = absolute(args.topic_name)
    with cli_node(args.node_name, use_sim_time=args.use_sim_time) as node:
        try:
            publisher = node.create_publisher(made, topic, qos.profile(args))
        except Exception as error:
            wrong = f"Cannot publish on the topic '{args.topic_name}': {str(error).splitlines()[0]}"
            raise Ros2Error(wrong) from error
        # Existing subscriptions should also receive the first message.
        settle(node, lambda: publisher.get_subscription_count() >= max(wanted, 1), args.spin_time)
        if wanted:
            _wait_for_subscriptions(node, publisher, topic, wanted, args.max_wait_time_secs)
        print("publisher: beginning loop", flush=True)
        _publish(node, publisher, message, stamps, times, args)
    return 0


def _publish(
    node: Node,
    publisher: Any,  # noqa: ANN401
    message: Any,  # noqa: ANN401
    stamps: list[message_values.Stamper],
    times: int,
    args: argparse.Namespace,
) -> None:
    """Publish `times` messages, or publish forever if `times` is 0.

    Then wait for acknowledgements, and keep the node running until `args.keep_alive` (s) has passed.
    """
    from grader.graph.discovery import nap, spin_until, wait_until_acknowledged

    begun = time.monotonic()
    sent = 0
    while not times or sent < times:
        left = begun + sent / args.rate - time.monotonic()
        # Spin the node to update its clock if simulated time is used.
        spin_until(node, lambda: False, left) if args.use_sim_time else nap(left)
        now = node.get_clock().now().to_msg()
        for stamp in stamps:
            stamp(now)
        publisher.publish(message)
        sent += 1
        if args.print and sent % args.print == 0:
            print(f"publishing #{sent}: {message!r}\n", flush=True)
    ended = time.monotonic()
    wait_until_acknowledged([publisher], _ACKNOWLEDGED_S, args.keep_alive)
    nap(ended + args.keep_alive - time.monotonic())


def _wait_for_subscriptions(
    node: Node,
    publisher: Any,  # noqa: ANN401
    topic: str,
    wanted: int,
    most_s: float | None,
) -> None:
    from grader.ros2.topic import topic_lookup

    begun = time.monotonic()
    reported_s = begun - _REPORTED_EVERY_S
    hint = topic_lookup.nearest_topic(node, topic)
    while publisher.get_subscription_count() < wanted:
        now = time.monotonic()
        if now - reported_s >= _REPORTED_EVERY_S:
            reported_s = now
            print(f"Waiting for at least {wanted} matching subscription(s)...", flush=True)
            if hint:
                print(hint, file=sys.stderr, flush=True)
                hint = ""
        if most_s is not None and now - begun >= most_s:
            message = (
                f"Timed out waiting for subscribers: Expected {wanted} subcribers but only got "
                f"{publisher.get_subscription_count()} subscribers"
            )
            raise Ros2Error(message)
        time.sleep(_POLL_S)

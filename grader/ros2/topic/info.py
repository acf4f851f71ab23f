"""The verb `topic info`: print the type of a topic, and count or list its publishers and subscriptions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, topics
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("topic_name", help="full name of the topic, such as /turtle1/pose"), topics)
    parser.add_argument(
        "--verbose",
        "-v",
        action="store_true",
        help="print every publisher and subscription: node, type, type hash, GID and QoS profile",
    )


def run(args: argparse.Namespace) -> int:
    """Print the type, and the numbers of publishers and subscriptions. With --verbose, also describe each of them.

    Raises:
        Ros2Error: the topic does not exist.
    """
    graph = look(args)
    name = args.topic_name
    types = types_of(graph.topics, name)
    if not types:
        raise Ros2Error(did_you_mean(name, graph.topic_names(), f"Unknown topic '{name}'", graph.node_names()))
    end = "\n\n" if args.verbose else "\n"
    print(f"Type: {types[0] if len(types) == 1 else list(types)}", end=end)
    for kind, publishes in (("Publisher", True), ("Subscription", False)):
        found = graph.ends(name, publishes=publishes)
        print(f"{kind} count: {len(found)}", end=end)
        for one in found if args.verbose else ():
            print(one.text, end=end)
    return 0

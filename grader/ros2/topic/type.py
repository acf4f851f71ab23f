"""The verb `topic type`: print the type of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import shown, types_of
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


def run(args: argparse.Namespace) -> int:
    """Print the type. If nodes use different types for the topic, print each type on a separate line.

    Raises:
        Ros2Error: the topic does not exist.
    """
    graph = look(args)
    types = types_of(tuple(shown(graph.topics, all_of_them=args.include_hidden_topics)), args.topic_name)
    if not types:
        raise Ros2Error(did_you_mean(args.topic_name, graph.topic_names()))
    print("\n".join(types))
    return 0

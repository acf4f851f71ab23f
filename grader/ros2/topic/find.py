"""The verb `topic find`: find the topics of a type."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.graph.graph_info import shown
from grader.ros import index
from grader.ros.failure import did_you_mean
from grader.ros2.completion import completes, message_types
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("topic_type", help="full type, such as geometry_msgs/msg/Twist"), message_types)
    parser.add_argument("-c", "--count-topics", action="store_true", help="print only the number of topics")
    parser.add_argument("--include-hidden-topics", action="store_true", help="include hidden topics")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the topics of the requested type, or their number. Return 0 even if there is none."""
    found = shown(look(args).topics, all_of_them=args.include_hidden_topics)
    names = [name for name, types in found if args.topic_type in types]
    print(len(names)) if args.count_topics else [print(name) for name in names]
    if not names and args.topic_type not in index.all_interfaces("msg"):
        hint = did_you_mean(args.topic_type, {name for _, types in found for name in types})
        if hint:
            print(hint, file=sys.stderr)
    return 0

"""The verb `node list`: print the names of the nodes."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse

_SAME_NAME = (
    "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have unintended side "
    "effects."
)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    parser.add_argument("-a", "--all", action="store_true", help="include hidden nodes, whose names start with _")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="print only the number of nodes")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the nodes, or only their number."""
    found = look(args).node_names(all_of_them=args.all)
    if args.count_nodes:
        print(len(found))
        return 0
    if len(set(found)) < len(found):
        print(_SAME_NAME, file=sys.stderr)
    for name in found:
        print(name)
    return 0

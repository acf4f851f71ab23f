"""The verb `lifecycle nodes`: print the names of the lifecycle nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros2.lifecycle.lifecycle_client import lifecycle_nodes
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    parser.add_argument("-a", "--all", action="store_true", help="include hidden nodes, whose names start with _")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="print only the number of nodes")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the nodes, or only their number."""
    found = lifecycle_nodes(args, hidden=args.all)
    if args.count_nodes:
        print(len(found))
    elif found:
        print(*found, sep="\n")
    return 0

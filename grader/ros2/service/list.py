"""The verb `service list`: print the names of the services."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import shown
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the type of each service")
    parser.add_argument("-c", "--count-services", action="store_true", help="print only the number of services")
    parser.add_argument("--include-hidden-services", action="store_true", help="include hidden services")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the services, or only their number."""
    found = shown(look(args).services, all_of_them=args.include_hidden_services)
    if args.count_services:
        print(len(found))
        return 0
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0

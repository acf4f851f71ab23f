"""The verb `action list`: print the names of all actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the type of each action")
    parser.add_argument("-c", "--count-actions", action="store_true", help="print only the number of actions")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the actions, or only their number."""
    found = look(args).actions
    if args.count_actions:
        print(len(found))
        return 0
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return 0

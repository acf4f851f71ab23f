"""The verb `action find`: find the actions of a type."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros.failure import did_you_mean
from grader.ros2.completion import all_action_types, completes
from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    kind = parser.add_argument("action_type", help="full type, such as turtlesim/action/RotateAbsolute")
    completes(kind, all_action_types)
    parser.add_argument("-c", "--count-actions", action="store_true", help="print only the number of actions")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the actions of the requested type, or their number. Return 0 even if there is none."""
    found = look(args).actions
    names = [name for name, types in found if args.action_type in types]
    print(len(names)) if args.count_actions else [print(name) for name in names]
    if not names and args.action_type not in index.all_interfaces("action"):
        hint = did_you_mean(args.action_type, {name for _, types in found for name in types})
        if hint:
            print(hint, file=sys.stderr)
    return 0

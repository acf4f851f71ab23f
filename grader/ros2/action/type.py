"""The verb `action type`: print the type of an action."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import actions, completes
from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("action_name", help="full name, such as /turtle1/rotate_absolute"), actions)


def run(args: argparse.Namespace) -> int:
    """Print the type. If nodes use different types, print each type on a separate line.

    Raises:
        Ros2Error: the action does not exist.
    """
    found = look(args).actions
    types = types_of(found, args.action_name)
    if not types:
        raise Ros2Error(did_you_mean(args.action_name, [name for name, _ in found]))
    print("\n".join(types))
    return 0

"""The verb `action info`: print the nodes that offer or use an action."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.graph.graph_info import types_of
from grader.ros.failure import did_you_mean
from grader.ros2.completion import actions, completes
from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("action_name", help="name, such as /turtle1/rotate_absolute"), actions)
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the type of the action")
    parser.add_argument("-c", "--count", action="store_true", help="print only the numbers of clients and servers")


def run(args: argparse.Namespace) -> int:
    """Print how many nodes use and offer the action, and the names of these nodes unless `--count` is given."""
    from grader.graph.names import absolute

    graph = look(args)
    name = absolute(args.action_name)
    print(f"Action: {args.action_name}")
    for title, found in (
        ("clients", [(node.name, types_of(node.action_clients, name)) for node in graph.nodes]),
        ("servers", [(node.name, types_of(node.action_servers, name)) for node in graph.nodes]),
    ):
        users = [(user, types) for user, types in found if types]
        print(f"Action {title}: {len(users)}")
        for user, types in users if not args.count else ():
            print(f"    {user} [{', '.join(types)}]" if args.show_types else f"    {user}")
    known = [known for known, _ in graph.actions]
    hint = did_you_mean(name, known) if name not in known else ""
    if hint:
        print(hint, file=sys.stderr)
    return 0

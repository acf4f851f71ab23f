"""The verb `lifecycle get`: print the state of a lifecycle node, or of all lifecycle nodes."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.lifecycle import lifecycle_client

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    text = "name of the node (default: all lifecycle nodes)"
    lifecycle_client.add_node(parser, "?", text)


def run(args: argparse.Namespace) -> int:
    """Print the state of the given lifecycle node, or of all lifecycle nodes.

    Raises:
        Ros2Error: the given node does not exist or does not respond.
    """
    from grader.graph.discovery import cli_node

    named = [lifecycle_client.chosen(args)] if args.node_name else []
    names = named or lifecycle_client.lifecycle_nodes(args, hidden=args.include_hidden_nodes)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        for name in names:
            try:
                state = lifecycle_client.call(node, "GetState", f"{name}/get_state").current_state
            except Ros2Error as error:
                if named:
                    raise
                print(error, file=sys.stderr)
                continue
            print(f"{'' if named else f'{name}: '}{state.label} [{state.id}]")
    return 0

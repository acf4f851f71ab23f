"""The verb `lifecycle list`: print the available transitions of a node."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros2.lifecycle import lifecycle_client

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    lifecycle_client.add_node(parser)
    parser.add_argument("-a", "--all", action="store_true", help="print the transitions of all states")


def run(args: argparse.Namespace) -> int:
    """Print the transitions.

    Raises:
        Ros2Error: the node does not exist or does not respond.
    """
    from grader.graph.discovery import cli_node

    name = lifecycle_client.chosen(args)
    service = "get_transition_graph" if args.all else "get_available_transitions"
    with cli_node(use_sim_time=args.use_sim_time) as node:
        answer = lifecycle_client.call(node, "GetAvailableTransitions", f"{name}/{service}")
    for found in answer.available_transitions:
        print(f"- {found.transition.label} [{found.transition.id}]")
        print(f"\tStart: {found.start_state.label}\n\tGoal: {found.goal_state.label}")
    return 0

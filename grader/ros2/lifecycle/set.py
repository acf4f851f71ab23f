"""The verb `lifecycle set`: trigger a transition of a node."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error
from grader.ros2.lifecycle import lifecycle_client

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    lifecycle_client.add_node(parser)
    parser.add_argument("transition", help="name or number of the transition, such as configure")


def run(args: argparse.Namespace) -> int:
    """Request the transition, and print whether it was successful.

    Raises:
        Ros2Error: the node does not exist or does not respond, or the transition is not available.
    """
    from grader.graph.discovery import cli_node

    name = lifecycle_client.chosen(args)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        answer = lifecycle_client.call(node, "GetAvailableTransitions", f"{name}/get_available_transitions")
        known = [one.transition for one in answer.available_transitions]
        wanted = next((one for one in known if args.transition in (one.label, str(one.id))), None)
        if wanted is None:
            lines = "".join(f"\n- {one.label} [{one.id}]" for one in known)
            message = f"Unknown transition requested, available ones are:{lines}"
            raise Ros2Error(message)
        import lifecycle_msgs.srv

        request = lifecycle_msgs.srv.ChangeState.Request(transition=wanted)
        done = lifecycle_client.call(node, "ChangeState", f"{name}/change_state", request).success
    print("Transitioning successful" if done else "Transitioning failed", file=sys.stdout if done else sys.stderr)
    return 0

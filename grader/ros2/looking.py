"""How verbs look at the graph: with the daemon, or with a node of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.look import Look, from_dict
from grader.ros2.daemon import client

if TYPE_CHECKING:
    import argparse


def look(args: argparse.Namespace) -> Look:
    """Return the graph as it is now: from the daemon, or with `args.no_daemon` from a node of this process.

    If no daemon is running, this starts one for the next command.

    Raises:
        Ros2Error: the node could not be created.
    """
    if not getattr(args, "no_daemon", False):
        answer = client.ask("look")
        if answer is not None:
            return from_dict(answer)
        client.start_for_later()
    # Import it only here, since rclpy takes long to import.
    from grader.graph.discovery import cli_node, settle
    from grader.graph.snapshot import snapshot

    with cli_node() as node:
        settle(node, deadline_s=getattr(args, "spin_time", None))
        return snapshot(node)

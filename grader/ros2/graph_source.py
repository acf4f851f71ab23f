"""Get the graph for a verb, from the daemon or from a node in this process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import Look, from_dict
from grader.ros2.daemon import client

if TYPE_CHECKING:
    import argparse


def look(args: argparse.Namespace) -> Look:
    """Return the current graph, either from the daemon or from a node in this process.

    If no daemon responds, start one for the next command (unless GRADER_ROS2_DAEMON=0). With `args.no_daemon`, do not
    use or start a daemon.

    Raises the same exceptions as `cli_node`.
    """
    if not getattr(args, "no_daemon", False):
        answer = client.request("look")
        if answer is not None:
            return from_dict(answer)
        client.start_for_later()
    # Import these modules only here, since importing rclpy takes a long time.
    from grader.graph.discovery import cli_node, settle
    from grader.graph.snapshot import snapshot

    with cli_node() as node:
        settle(node, deadline_s=getattr(args, "spin_time", None))
        return snapshot(node)

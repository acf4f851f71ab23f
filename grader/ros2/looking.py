"""Looking at the graph: by the daemon, or by a node that this process makes for the purpose."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.look import Look, from_dict
from grader.ros2.daemon import client

if TYPE_CHECKING:
    import argparse


def look(args: argparse.Namespace) -> Look:
    """The graph now: from the daemon unless `args.no_daemon` is set, else by a node of our own.

    A daemon that is missing is started for the next time.

    Raises:
        Ros2Error: no node could be made.
    """
    if not getattr(args, "no_daemon", False):
        answer = client.ask("look")
        if answer is not None:
            return from_dict(answer)
        client.start_for_later()
    # Only here, since rclpy takes long to import.
    from grader.graph.discovery import cli_node, settle
    from grader.graph.snapshot import snapshot

    with cli_node() as node:
        settle(node, deadline_s=getattr(args, "spin_time", None))
        return snapshot(node)

"""The verb `node info`: print the topics, services and actions of a node."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.graph.graph_info import shown
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, nodes
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("node_name", help="full name of the node, such as /turtlesim"), nodes)
    parser.add_argument("--include-hidden", action="store_true", help="include hidden nodes, topics, services, actions")


def run(args: argparse.Namespace) -> int:
    """Print the topics, services and actions of the node.

    Raises:
        Ros2Error: the node does not exist.
    """
    name = args.node_name
    graph = look(args)
    names = graph.node_names(all_of_them=args.include_hidden)
    if name not in names:
        raise Ros2Error(did_you_mean(name, names, f"Unable to find node '{name}'", names))
    if names.count(name) > 1:
        text = f'There are {names.count(name)} nodes in the graph with the exact name "{name}".'
        print(f"{text} You are seeing information about only one of them.", file=sys.stderr)
    node = next(node for node in graph.nodes if node.name == name)
    print(name)
    for title, found in (
        ("Subscribers", node.subscribers),
        ("Publishers", node.publishers),
        ("Service Servers", node.service_servers),
        ("Service Clients", node.service_clients),
        ("Action Servers", node.action_servers),
        ("Action Clients", node.action_clients),
    ):
        print(f"  {title}:")
        # The real ros2 prints an empty line after an empty section.
        visible = shown(found, all_of_them=args.include_hidden)
        print("\n".join(f"    {one}: {', '.join(types)}" for one, types in visible))
    return 0

"""The verb `service info`: print the type of a service, and the numbers of its clients and servers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import shown, types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, services
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("service_name", help="full name of the service, such as /spawn"), services)


def run(args: argparse.Namespace) -> int:
    """Print the type of the service, and the numbers of its clients and servers.

    Raises:
        Ros2Error: the service does not exist.
    """
    graph = look(args)
    name = args.service_name
    types = types_of(tuple(shown(graph.services, all_of_them=args.include_hidden_services)), name)
    if not types:
        raise Ros2Error(did_you_mean(name, graph.service_names(), f"Unknown service '{name}'", graph.node_names()))
    clients, servers = graph.service_counts.get(name, (0, 0))
    print(f"Type: {types[0] if len(types) == 1 else list(types)}")
    print(f"Clients count: {clients}")
    print(f"Services count: {servers}")
    return 0

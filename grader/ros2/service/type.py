"""The verb `service type`: print the type of a service."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import shown, types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, services
from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("service_name", help="full name of the service, such as /spawn"), services)


def run(args: argparse.Namespace) -> int:
    """Print the type. If nodes use different types, print each type on a separate line.

    Raises:
        Ros2Error: the service does not exist.
    """
    graph = look(args)
    types = types_of(tuple(shown(graph.services, all_of_them=args.include_hidden_services)), args.service_name)
    if not types:
        raise Ros2Error(did_you_mean(args.service_name, graph.service_names()))
    print("\n".join(types))
    return 0

"""The verb `component list`: print the running containers. Only a full ROS 2 can list the components in a container."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.graph.graph_info import types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse

_LIST_NODES = "composition_interfaces/srv/ListNodes"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    parser.add_argument("container_node_name", nargs="?", help="name of a container")
    parser.add_argument("--containers-only", action="store_true", help="print only the containers")


def run(args: argparse.Namespace) -> int:
    """Print the containers. With a name and --containers-only, only check that the container exists.

    Raises:
        Ros2Error: the container does not exist, or the user requested a list of components, which is not supported.
    """
    graph = look(args)
    names = sorted(set(graph.node_names()))
    found = [name for name in names if _LIST_NODES in types_of(graph.services, f"{name}/_container/list_nodes")]
    if args.container_node_name is None:
        print("".join(f"{name}\n" for name in found), end="")
        return 0
    if args.container_node_name not in found:
        text = f"Unable to find container node '{args.container_node_name}'"
        raise Ros2Error(did_you_mean(args.container_node_name, found, text))
    if not args.containers_only:
        message = "Only a full ROS 2 can list the components of a container"
        raise Ros2Error(message)
    return 0

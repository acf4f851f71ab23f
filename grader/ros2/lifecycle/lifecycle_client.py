"""Find lifecycle nodes, and call their services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.graph.graph_info import types_of
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes
from grader.ros2.graph_source import look
from grader.ros2.options import add_look

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

ANSWER_S = 10.0
"""The maximum time to wait for a response from a busy node (s)."""
_GET_STATE = "lifecycle_msgs/srv/GetState"


def add_node(parser: argparse.ArgumentParser, nargs: str | None = None, text: str = "name of the node") -> None:
    """Add the arguments of a verb for one node."""
    add_look(parser)
    completes(
        parser.add_argument("node_name", nargs=nargs, help=text),
        lambda parsed_args, **_: lifecycle_nodes(parsed_args, hidden=parsed_args.include_hidden_nodes),
    )
    parser.add_argument(
        "--include-hidden-nodes", action="store_true", help="include hidden nodes, whose names start with _"
    )


def lifecycle_nodes(args: argparse.Namespace, *, hidden: bool) -> list[str]:
    """Return the full names of the lifecycle nodes, sorted. Hidden nodes are included only if `hidden` is true."""
    graph = look(args)
    names = sorted(set(graph.node_names(all_of_them=hidden)))
    return [name for name in names if _GET_STATE in types_of(graph.services, f"{name}/get_state")]


def chosen(args: argparse.Namespace) -> str:
    """Return the full name of the node on the command line.

    Raises:
        Ros2Error: no lifecycle node has this name.
    """
    name = args.node_name if args.node_name.startswith("/") else f"/{args.node_name}"
    known = lifecycle_nodes(args, hidden=args.include_hidden_nodes)
    if name not in known:
        raise Ros2Error(did_you_mean(name, known, "Node not found"))
    return name


def call(node: Node, kind: str, service: str, request: Any = None) -> Any:  # noqa: ANN401
    """Call a service whose type is in lifecycle_msgs, and return the response.

    Raises:
        Ros2Error: the node does not respond.
    """
    import lifecycle_msgs.srv

    from grader.graph.discovery import settle, spin_until

    made = getattr(lifecycle_msgs.srv, kind)
    client = node.create_client(made, service)
    settle(node, client.service_is_ready)
    future = client.call_async(request if request is not None else made.Request())
    if not spin_until(node, future.done, ANSWER_S):
        message = f"Exception while calling service of node '{service.rpartition('/')[0]}': the node did not respond"
        raise Ros2Error(message)
    return future.result()

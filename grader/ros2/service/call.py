"""The verb `service call`: call a service and print its response."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from grader.common.words import a_list
from grader.graph.names import absolute, hidden
from grader.ros import message_values
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.completion import completes, prototype, service_types, services
from grader.ros2.given_file import standard_input

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

_POLL_S = 0.02


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("service_name", help="name of the service, such as /spawn"), services)
    completes(
        parser.add_argument("service_type", help="type of the service, such as turtlesim/srv/Spawn"), service_types
    )
    source = parser.add_mutually_exclusive_group()
    given = source.add_argument(
        "values",
        nargs="?",
        default="{}",
        help='the request, such as "{x: 2.0}"; missing fields get their default values',
    )
    completes(given, prototype("service_type", "srv", "Request"))
    source.add_argument("--stdin", action="store_true", help="read the request from standard input")
    parser.add_argument("-r", "--rate", metavar="N", type=float, help="call the service repeatedly, N times per second")


def run(args: argparse.Namespace) -> int:
    """Call the service once, or repeatedly until Ctrl-C if --rate is given.

    Raises:
        Ros2Error: the rate or the name is invalid, the type is not installed, or the request cannot be read or does
            not match the type.
    """
    from grader.graph.discovery import cli_node, nap, settle, spin_until

    if args.rate is not None and not args.rate > 0:
        message = "rate must be greater than zero"
        raise Ros2Error(message)
    made = message_values.load_type(args.service_type, "srv", "service type")
    given = standard_input() if args.stdin else args.values
    request = message_values.fill(made.Request(), message_values.parse(given, dictionary=False))
    name = absolute(args.service_name)
    package, last = args.service_type.split("/")[0], args.service_type.split("/")[-1]
    with cli_node(f"_ros2cli_requester_{package}_{last}") as node:
        try:
            client = node.create_client(made, name)
        except Exception as error:
            message = f"The service '{args.service_name}' cannot be called: {str(error).splitlines()[0]}"
            raise Ros2Error(message) from error
        settle(node, client.service_is_ready)
        if not client.service_is_ready():
            print("waiting for service to become available...", flush=True)
            _say_why(node, name, args.service_type)
            while not client.service_is_ready():
                time.sleep(_POLL_S)
        while True:
            print(f"requester: making request: {request!r}\n", flush=True)
            requested = time.monotonic()
            future = client.call_async(request)
            spin_until(node, future.done)
            print(f"response:\n{future.result()!r}\n", flush=True)
            if args.rate is None:
                return 0
            nap(requested + 1 / args.rate - time.monotonic())


def _say_why(node: Node, name: str, requested: str) -> None:
    """Print a hint if the service does not exist with this type, because the type or the name may be wrong."""
    found: dict[str, Any] = {name: types for name, types in node.get_service_names_and_types() if not hidden(name)}
    # Our client announces the service with the requested type, too.
    others = [kind for kind in found.pop(name, []) if kind != requested]
    hint = (
        f"The service {name} has the type{'s' if len(others) > 1 else ''} {a_list(others)}."
        if others
        else did_you_mean(name, found, nodes=node.get_node_names())
    )
    if hint:
        print(hint, file=sys.stderr, flush=True)

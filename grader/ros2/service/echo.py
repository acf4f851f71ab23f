"""The verb `service echo`: print the requests and responses of a service with introspection enabled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.graph.names import absolute
from grader.ros import message_values
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros.rendering import Form, dumped, plain, to_csv
from grader.ros2 import qos
from grader.ros2.completion import completes, service_types, services
from grader.ros2.format_options import add_form, form_of

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node

_EVENTS = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("service_name", help="name of the service, such as /spawn"), services)
    completes(
        parser.add_argument(
            "service_type", nargs="?", help="type of the service, required if the service does not exist"
        ),
        service_types,
    )
    parser.add_argument(
        "--csv", action="store_true", help="print each event on one line, with commas between the values"
    )
    qos.add_qos(parser, "services_default")
    add_form(parser)


def run(args: argparse.Namespace) -> int:
    """Print the events until Ctrl-C.

    Raises:
        Ros2Error: the name or the QoS is invalid, or the type of the service cannot be determined or is not installed.
    """
    from grader.graph.discovery import cli_node, settle, spin_until
    from grader.ros2.topic import topic_lookup

    form = form_of(args)
    with cli_node() as node:
        name = absolute(args.service_name)
        topic = topic_lookup.expanded(node, f"{name}/_service_event")
        settle(node, lambda: node.count_publishers(topic) > 0)
        made = _class(node, name, args)

        def show(event: Any) -> None:  # noqa: ANN401
            print(to_csv(event, form) if args.csv else _as_yaml(event, form), flush=True)

        node.create_subscription(made.Event, topic, show, qos.profile(args))
        if node.count_publishers(topic) < 1:
            warning = f"No publishers on topic '{args.service_name}/_service_event'; "
            print(f"{warning}is service introspection on the client or server enabled?", flush=True)
        spin_until(node, lambda: False)
    return 0


def _class(node: Node, name: str, args: argparse.Namespace) -> Any:  # noqa: ANN401
    if args.service_type:
        return message_values.load_type(
            args.service_type, "srv", text=f"The service type '{args.service_type}' is invalid"
        )
    found = dict(node.get_service_names_and_types())
    types = found.get(name, [])
    if not types:
        raise Ros2Error(did_you_mean(name, found, f"Cannot find type for '{args.service_name}'"))
    if len(types) > 1:
        message = f"More than one type associated with service '{args.service_name}'"
        raise Ros2Error(message)
    return message_values.load_type(types[0], "srv", text=f"The service type '{types[0]}' is invalid")


def _as_yaml(event: Any, form: Form) -> str:  # noqa: ANN401
    """Return an event as YAML, with the name of the event type instead of its number."""
    shown = plain(event, form)
    shown["info"]["event_type"] = _EVENTS[shown["info"]["event_type"]]
    return f"{dumped(shown, form)}---"

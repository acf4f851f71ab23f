"""The verb `topic echo`: print what arrives on a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from grader.graph.discovery import cli_node, published, settle, spin_until
from grader.graph.names import absolute
from grader.ros import values
from grader.ros.failure import Ros2Error
from grader.ros2.topic import unknown_topic

if TYPE_CHECKING:
    import argparse

    from rclpy.node import Node


def echo(args: argparse.Namespace) -> int:
    """Print until Ctrl-C, or one message with --once."""
    topic = absolute(args.topic_name)
    limit = None if args.full_length else args.truncate_length
    arrived = 0

    def show(message: Any) -> None:  # noqa: ANN401
        nonlocal arrived
        if args.once and arrived:
            return
        arrived += 1
        part = values.field(message, args.field) if args.field else message
        text = values.to_csv(part, limit) + "\n" if args.csv else values.to_yaml(part, limit) + "---\n"
        print(text, end="", flush=True)

    with cli_node() as node:
        # With the type given there is nothing to wait for but the publishers, by whom the QoS is chosen.
        settle(node, lambda: published(node, topic), args.spin_time)
        name = args.message_type or type_of(node, topic)
        made = values.load_type(name, "msg", "message type")
        if args.field:
            values.field(made(), args.field)
        subscription = node.create_subscription(made, topic, show, qos_of(node, topic))
        spin_until(node, lambda: args.once and arrived > 0)
        node.destroy_subscription(subscription)
    return 0


def type_of(node: Node, topic: str) -> str:
    """The type of a topic.

    Raises:
        Ros2Error: there is no such topic, or it has several types.
    """
    types: list[str] = next((types for name, types in node.get_topic_names_and_types() if name == topic), [])
    if not types:
        print(f"WARNING: topic [{topic}] does not appear to be published yet")
        raise unknown_topic(node, topic, "Could not determine the type for the passed topic")
    if len(types) > 1:
        message = f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]"
        raise Ros2Error(message)
    return types[0]


def qos_of(node: Node, topic: str) -> QoSProfile:
    """A QoS that hears every publisher: as strict as the least strict of them."""
    publishers = [publisher.qos_profile for publisher in node.get_publishers_info_by_topic(topic)]
    reliable = all(qos.reliability == QoSReliabilityPolicy.RELIABLE for qos in publishers)
    kept = publishers and all(qos.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for qos in publishers)
    return QoSProfile(
        depth=100,
        reliability=QoSReliabilityPolicy.RELIABLE if reliable else QoSReliabilityPolicy.BEST_EFFORT,
        durability=QoSDurabilityPolicy.TRANSIENT_LOCAL if kept else QoSDurabilityPolicy.VOLATILE,
    )

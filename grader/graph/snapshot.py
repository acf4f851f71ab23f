"""Take a snapshot of the graph that a node sees."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.node import NodeNameNonExistentError

from grader.common.words import printable
from grader.graph.graph_info import EndpointLook, Look, Named, NodeLook
from grader.graph.valid_names import valid

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rclpy.node import Node


def snapshot(node: Node) -> Look:
    """Return the graph as `node` sees it now. Call `discovery.settle` first to get the whole graph."""
    topics = _named(node.get_topic_names_and_types())
    services = _named(node.get_service_names_and_types())
    return Look(
        nodes=tuple(
            sorted((_node(node, *found) for found in node.get_node_names_and_namespaces()), key=lambda one: one.name)
        ),
        topics=topics,
        endpoints=tuple(_endpoints(node, (name for name, _ in topics))),
        services=services,
        service_counts={name: (node.count_clients(name), node.count_services(name)) for name, _ in services},
        actions=_named(valid(get_action_names_and_types(node))),
    )


def _named(found: Iterable[tuple[str, list[str]]]) -> tuple[Named, ...]:
    return tuple(sorted((name, tuple(types)) for name, types in found))


def _node(node: Node, name: str, namespace: str) -> NodeLook:
    full = f"{namespace.rstrip('/')}/{name}"
    # The node may have disappeared in the meantime.
    with suppress(NodeNameNonExistentError):
        return NodeLook(
            full,
            subscribers=_named(node.get_subscriber_names_and_types_by_node(name, namespace)),
            publishers=_named(node.get_publisher_names_and_types_by_node(name, namespace)),
            service_servers=_named(node.get_service_names_and_types_by_node(name, namespace)),
            service_clients=_named(node.get_client_names_and_types_by_node(name, namespace)),
            action_servers=_named(get_action_server_names_and_types_by_node(node, name, namespace)),
            action_clients=_named(get_action_client_names_and_types_by_node(node, name, namespace)),
        )
    return NodeLook(full)


def _endpoints(node: Node, topics: Iterable[str]) -> Iterable[EndpointLook]:
    for topic in topics:
        for info in node.get_publishers_info_by_topic(topic):
            yield _endpoint(topic, info, publishes=True)
        for info in node.get_subscriptions_info_by_topic(topic):
            yield _endpoint(topic, info, publishes=False)


def _endpoint(topic: str, info: Any, *, publishes: bool) -> EndpointLook:  # noqa: ANN401
    qos = info.qos_profile
    info.node_name, info.topic_type = printable(info.node_name), printable(info.topic_type)
    return EndpointLook(
        topic, publishes, info.node_name, qos.reliability.short_key, qos.durability.short_key, str(info)
    )

"""A snapshot of the graph: nodes, topics, services and actions as plain data. This module does not need rclpy."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from grader.graph.names import hidden

Named = tuple[str, tuple[str, ...]]
"""A name and its types. There is more than one type if nodes use different types for the same name."""


@dataclass(frozen=True)
class NodeLook:
    """The full name of a node, and everything that it offers and uses."""

    name: str
    subscribers: tuple[Named, ...] = ()
    publishers: tuple[Named, ...] = ()
    service_servers: tuple[Named, ...] = ()
    service_clients: tuple[Named, ...] = ()
    action_servers: tuple[Named, ...] = ()
    action_clients: tuple[Named, ...] = ()


@dataclass(frozen=True)
class EndpointLook:
    """A publisher or a subscription. `text` is the output of `topic info --verbose` for this endpoint."""

    topic: str
    publishes: bool
    node: str
    """The name of the endpoint's node, without the namespace."""
    reliability: str
    """The reliability is "reliable" or "best_effort", as in `--qos-reliability`."""
    durability: str
    """The durability is "volatile" or "transient_local", as in `--qos-durability`."""
    text: str


@dataclass(frozen=True)
class Look:
    """The graph at one moment, sorted by name.

    `service_counts` contains the number of clients and servers per service.
    """

    nodes: tuple[NodeLook, ...] = ()
    topics: tuple[Named, ...] = ()
    endpoints: tuple[EndpointLook, ...] = ()
    services: tuple[Named, ...] = ()
    service_counts: dict[str, tuple[int, int]] = field(default_factory=dict)
    actions: tuple[Named, ...] = ()

    def node_names(self, *, all_of_them: bool = False) -> list[str]:
        """Return the full names of the nodes, sorted. Hidden nodes are included only if `all_of_them` is true.

        If several nodes have the same name, the list contains this name several times.
        """
        return [node.name for node in self.nodes if all_of_them or not _hidden_node(node.name)]

    def topic_names(self, *, all_of_them: bool = False) -> list[str]:
        """Return the names of the topics, sorted. Hidden names are included only if `all_of_them` is true."""
        return [name for name, _ in shown(self.topics, all_of_them=all_of_them)]

    def service_names(self, *, all_of_them: bool = False) -> list[str]:
        """Return the names of the services, sorted. Hidden names are included only if `all_of_them` is true."""
        return [name for name, _ in shown(self.services, all_of_them=all_of_them)]

    def ends(self, topic: str, *, publishes: bool) -> list[EndpointLook]:
        """Return the publishers of a topic, or its subscriptions."""
        return [end for end in self.endpoints if end.topic == topic and end.publishes == publishes]

    def to_dict(self) -> dict[str, Any]:
        """Return the snapshot as data that can be written as JSON."""
        return asdict(self)


def shown(found: tuple[Named, ...], *, all_of_them: bool) -> list[Named]:
    """Return the names with their types. Hidden names are included only if `all_of_them` is true."""
    return [(name, types) for name, types in found if all_of_them or not hidden(name)]


def types_of(found: tuple[Named, ...], name: str) -> tuple[str, ...]:
    """Return the types that belong to this name, or an empty tuple if the name does not exist."""
    return next((types for known, types in found if known == name), ())


def from_dict(data: dict[str, Any]) -> Look:
    """Create a snapshot from data that `to_dict` returned."""
    return Look(
        nodes=tuple(
            NodeLook(node.pop("name"), **{key: _named(value) for key, value in node.items()}) for node in data["nodes"]
        ),
        topics=_named(data["topics"]),
        endpoints=tuple(EndpointLook(**end) for end in data["endpoints"]),
        services=_named(data["services"]),
        service_counts={name: (counts[0], counts[1]) for name, counts in data["service_counts"].items()},
        actions=_named(data["actions"]),
    )


def _named(value: Any) -> tuple[Named, ...]:  # noqa: ANN401
    return tuple((name, tuple(types)) for name, types in value)


def _hidden_node(full_name: str) -> bool:
    return full_name.rpartition("/")[2].startswith("_")

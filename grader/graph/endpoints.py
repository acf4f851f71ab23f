"""The part of the graph that a node has discovered: other nodes, publishers and subscriptions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import printable

if TYPE_CHECKING:
    from rclpy.node import Node


@dataclass(frozen=True)
class End:
    """A publisher or subscription, like `grader.trial.recording.Endpoint`, for processes that do not import numpy."""

    kind: str
    node: str
    topic: str
    type: str


@dataclass(frozen=True)
class Observed:
    """The full names of all other nodes (one entry per node) and their publishers and subscriptions, all sorted."""

    nodes: tuple[str, ...]
    ends: tuple[End, ...]


def observe(node: Node) -> Observed:
    """Return the part of the graph that `node` has already discovered.

    To get the whole graph, call `discovery.settle` first.

    A node without any publisher or subscription is left out. Each node publishes at least /parameter_events. However,
    on a busy machine, rmw_dds_common can handle the last list of a participant's nodes after the end of the participant
    (GraphCache::update_participant_entities adds an unknown participant). Such a node would never leave the graph.
    """
    own = node.get_fully_qualified_name()
    ends = []
    for topic, _ in node.get_topic_names_and_types():
        for kind, infos in (
            ("publisher", node.get_publishers_info_by_topic(topic)),
            ("subscription", node.get_subscriptions_info_by_topic(topic)),
        ):
            ends += [End(kind, _full(i.node_name, i.node_namespace), topic, printable(i.topic_type)) for i in infos]
    known = {end.node for end in ends} - {own}
    names = [_full(name, namespace) for name, namespace in node.get_node_names_and_namespaces()]
    return Observed(
        tuple(sorted(name for name in names if name in known)),
        tuple(sorted((end for end in ends if end.node != own), key=lambda end: (end.topic, end.kind, end.node))),
    )


def _full(name: str, namespace: str) -> str:
    return printable(f"{namespace.rstrip('/')}/{name}")

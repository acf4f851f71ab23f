"""What a node has heard of the graph: every other node, and its publishers and subscriptions. Needs rclpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node


@dataclass(frozen=True)
class End:
    """A publisher or subscription, like `grader.trial.recording.Endpoint`, which would cost the import of numpy."""

    kind: str
    node: str
    topic: str
    type: str


@dataclass(frozen=True)
class Heard:
    """Everybody but the one who listens: full names of the nodes, one entry a node, and their ends; sorted."""

    nodes: tuple[str, ...]
    ends: tuple[End, ...]


def heard(node: Node) -> Heard:
    """What `node` has heard of by now; `discovery.settle` waits until that is all."""
    own = node.get_fully_qualified_name()
    names = [_full(name, namespace) for name, namespace in node.get_node_names_and_namespaces()]
    ends = []
    for topic, _ in node.get_topic_names_and_types():
        for kind, infos in (
            ("publisher", node.get_publishers_info_by_topic(topic)),
            ("subscription", node.get_subscriptions_info_by_topic(topic)),
        ):
            ends += [End(kind, _full(i.node_name, i.node_namespace), topic, i.topic_type) for i in infos]
    return Heard(
        tuple(sorted(name for name in names if name != own)),
        tuple(sorted((end for end in ends if end.node != own), key=lambda end: (end.topic, end.kind, end.node))),
    )


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"

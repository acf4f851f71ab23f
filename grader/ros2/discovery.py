"""Discovery: an observing node, when it has heard of everybody, and what it has heard. Needs rclpy.

A node hears of others little by little: first their publishers and subscriptions, without the names of their nodes,
then the names. Measured with turtlesim and draw_circle on two busy cores: all of it within 0.2 to 0.7 s, with pauses of
up to 0.4 s while some endpoint's node had no name yet, and of at most 0.07 s otherwise.
"""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

if TYPE_CHECKING:
    from collections.abc import Iterator

QUIET_S = 0.2
"""Nothing new for so long, and the graph counts as settled."""
FIRST_S = 1.5
"""So long the first endpoint is waited for; after that nothing is running."""
DEADLINE_S = 3.0
"""So long the rest is waited for, where it does not come to rest."""
UNKNOWN = "_NODE_NAME_UNKNOWN_"
"""What rclpy calls the node of an endpoint whose name has not arrived; programs without ROS 2 keep that name."""

_POLL_S = 0.01


@dataclass(frozen=True)
class End:
    """A publisher or subscription, as `grader.recording.Endpoint`, which would cost the import of numpy."""

    kind: str
    node: str
    topic: str
    type: str


@dataclass(frozen=True)
class Heard:
    """Everybody but the observer: full names of the nodes (one entry a node), and their ends; sorted."""

    nodes: tuple[str, ...]
    ends: tuple[End, ...]


@contextmanager
def observer(name: str) -> Iterator[Node]:
    """A hidden node that adds nothing to the graph; a signal ends it like any Python program."""
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = Node(
            f"_{name}_{os.getpid()}",
            enable_rosout=False,
            start_parameter_services=False,
            use_global_arguments=False,
        )
        try:
            yield node
        finally:
            node.destroy_node()
    finally:
        rclpy.try_shutdown()


def settle(node: Node, *, quiet_s: float = QUIET_S, first_s: float = FIRST_S, deadline_s: float = DEADLINE_S) -> bool:
    """Wait until `node` has heard of everybody; returns whether it heard of anybody (all times in s).

    That is so when there was something, then nothing new for `quiet_s`, and every endpoint's node has its name.
    """
    begin = changed = time.monotonic()
    before = now_heard = _all(node)
    while True:
        now = time.monotonic()
        anybody, nameless = now_heard[0], now_heard[1]
        if anybody and not nameless and now - changed >= quiet_s:
            return True
        if now - begin >= (deadline_s if anybody else first_s):
            return bool(anybody)
        time.sleep(_POLL_S)
        now_heard = _all(node)
        if now_heard != before:
            before, changed = now_heard, time.monotonic()


def heard(node: Node) -> Heard:
    """What the node has heard of by now."""
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


def _all(node: Node) -> tuple[int, bool, object]:
    """How many others there are, whether one of them has no name yet, and all of it to compare."""
    seen = heard(node)
    nameless = any(end.node.endswith(UNKNOWN) for end in seen.ends)
    services = sorted(name for name, _ in node.get_service_names_and_types())
    return len(seen.nodes) + len(seen.ends), nameless, (seen, services)


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"

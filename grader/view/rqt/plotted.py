"""The values of numeric fields over time, for the page of rqt_plot. A field has a name such as `/turtle1/pose/x`."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSProfile, QoSReliabilityPolicy

from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.view.rqt.plot_fields import expand, numeric, topic_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rclpy.node import Node

    from grader.graph.endpoints import Observed

MOST_FIELDS = 20
"""The maximum number of fields that the user adds, and of numbers that are plotted for a field with several numbers."""
_QOS = QoSProfile(depth=100, reliability=QoSReliabilityPolicy.BEST_EFFORT)
_WAITING = "Waiting for a publisher of this topic."

Sample = tuple[float, float | None]
"""A time (in s from an arbitrary start) and the value at this time. The value is None if it is infinite or not a
number."""


@dataclass
class _Topic:
    """A subscription to a topic, with the plotted fields: the name and the path of each field in the message."""

    subscription: Any
    type: str
    paths: dict[str, str] = field(default_factory=dict)


class Plotted:
    """Subscribes to the topics of the wanted fields. Once the node spins, all methods run in its thread.

    `flush` passes the new samples of each field and the problem of each wanted field ("" for none) to `tell`.
    """

    def __init__(self, node: Node, tell: Callable[[dict[str, list[Sample]], dict[str, str]], object]) -> None:
        self._node = node
        self._tell = tell
        self._begun = time.monotonic()
        self._wanted: dict[str, str] = {}
        self._topics: dict[str, _Topic] = {}
        self._new: dict[str, list[Sample]] = {}
        self._told: dict[str, str] = {}

    def add(self, typed: str) -> None:
        """Plot the fields that the user typed, until there are MOST_FIELDS of them.

        For a topic, or a field that is a message itself, plot all of its numbers.
        """
        for name in expand(typed):
            if len(self._wanted) < MOST_FIELDS:
                self._wanted.setdefault(name, _WAITING)

    def remove(self, name: str) -> None:
        """Stop plotting a field. If it is part of another wanted field, the other parts are plotted again."""
        self._wanted.pop(name, None)
        for topic in list(self._topics):
            paths = self._topics[topic].paths
            for series in [series for series in paths if f"{series}/".startswith(f"{name}/")]:
                del paths[series]
                self._new.pop(series, None)
            if not paths:
                self._node.destroy_subscription(self._topics.pop(topic).subscription)
        for other in self._wanted:
            if f"{other}/".startswith(f"{name}/") or f"{name}/".startswith(f"{other}/"):
                self._wanted[other] = _WAITING

    def look(self, observed: Observed) -> None:
        """Subscribe to the topic of each wanted field as soon as the topic has a publisher."""
        types = {end.topic: end.type for end in observed.ends if end.kind == "publisher"}
        for name, problem in list(self._wanted.items()):
            if problem:
                self._wanted[name] = self._begin(name, types)

    def flush(self) -> None:
        """Call `tell` with the samples since the last flush and the problem of each field.

        `tell` is not called if there are no new samples and no problem has changed.
        """
        if any(self._new.values()) or self._wanted != self._told:
            self._tell(self._new, dict(self._wanted))
            self._told = dict(self._wanted)
            self._new = {}

    def _begin(self, name: str, types: Mapping[str, str]) -> str:
        """Subscribe to the topic of this field. Return "", or the reason why the subscription is not possible yet."""
        topic = topic_of(name, types)
        if topic is None:
            return _WAITING
        try:
            made = message_values.load_type(types[topic], "msg")
            paths = numeric(made(), name[len(topic) :].strip("/").replace("/", "."))
        except Ros2Error as error:
            return str(error).splitlines()[0]
        if topic not in self._topics:
            subscription = self._node.create_subscription(made, topic, lambda m: self._arrived(topic, m), _QOS)
            self._topics[topic] = _Topic(subscription, types[topic])
        self._topics[topic].paths.update({f"{topic}/{path.replace('.', '/')}": path for path in paths[:MOST_FIELDS]})
        return ""

    def _arrived(self, topic: str, message: Any) -> None:  # noqa: ANN401
        now = round(time.monotonic() - self._begun, 4)
        for name, path in self._topics[topic].paths.items():
            value = message_values.field(message, path, complete=False)
            if value is not None:
                number = float(value)
                self._new.setdefault(name, []).append((now, number if math.isfinite(number) else None))

"""Record every topic of a running ROS graph, and the graph itself. Runs in the conductor, beside the simulator."""

from __future__ import annotations

import importlib
import re
import time
from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

from grader.recording import Command, Endpoint, Graph, LogLine, Message

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rclpy.qos import TopicEndpointInfo

OWN_NAMESPACE = "/_grader"
_TYPE = re.compile(r"([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9]*)")
_LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}

# A node that makes topics or messages without end must not fill the grader's memory.
MOST_TOPICS = 100
MOST_MESSAGES = 20_000
MOST_BYTES = 32 * 1024 * 1024


class Recorder(Node):
    """A hidden node that subscribes to what appears in the graph."""

    def __init__(self, now: Callable[[], float], prefixes: list[Path], simulated: dict[str, str]) -> None:
        """`now` is the trial's clock (s); `prefixes` hold the installed message types.

        `simulated` topics (name -> type) are those that the simulator tells of itself.
        """
        super().__init__("recorder", namespace=OWN_NAMESPACE, start_parameter_services=False, enable_rosout=False)
        self.now = now
        self.messages: list[Message] = []
        self.commands: list[Command] = []
        self.log: list[LogLine] = []
        self.graphs: list[Graph] = []
        self.topics: dict[str, set[str]] = {}
        self.dropped = 0
        self._prefixes = prefixes
        self._simulated = simulated
        self._known: set[tuple[str, str]] = set()
        self._bytes = 0

    def keep(self, topic: str, type_name: str, data: bytes) -> bool:
        """Keep a message that arrived now; false when the recording is full."""
        if len(self.messages) >= MOST_MESSAGES or self._bytes + len(data) > MOST_BYTES:
            self.dropped += 1
            return False
        self._bytes += len(data)
        self.messages.append(Message(topic, type_name, data, self.now(), time.monotonic()))
        return True

    def keep_command(self, topic: str, data: bytes, twist: Any) -> None:  # noqa: ANN401 - a ROS message
        """Keep a Twist as the turtle got it."""
        if self.keep(topic, "geometry_msgs/msg/Twist", data) and topic == "/turtle1/cmd_vel":
            last = self.messages[-1]
            linear = (twist.linear.x, twist.linear.y, twist.linear.z)
            angular = (twist.angular.x, twist.angular.y, twist.angular.z)
            self.commands.append(Command(last.t_s, last.mono_s, linear, angular))

    def follow_graph(self) -> bool:
        """Subscribe to topics that are new; true when there were any."""
        fresh = False
        for topic, types in self.get_topic_names_and_types():
            if topic not in self.topics and len(self.topics) >= 10 * MOST_TOPICS:
                continue
            self.topics.setdefault(topic, set()).update(types)
            for type_name in types:
                if (topic, type_name) not in self._known and self._wanted(topic, type_name):
                    self._known.add((topic, type_name))
                    fresh |= self._subscribe(topic, type_name)
        return fresh

    def snapshot(self) -> None:
        """Add the graph as it is now."""
        nodes, endpoints = [], []
        for name, namespace in self.get_node_names_and_namespaces()[:MOST_TOPICS]:
            if namespace.startswith(OWN_NAMESPACE):
                continue
            full = f"{namespace.rstrip('/')}/{name}"
            nodes.append(full)
            try:
                publishers = self.get_publisher_names_and_types_by_node(name, namespace)
                subscriptions = self.get_subscriber_names_and_types_by_node(name, namespace)
            except Exception:
                continue
            for topic, types in publishers[:MOST_TOPICS]:
                endpoints += [Endpoint("publisher", full, topic, type_name) for type_name in types]
            for topic, types in subscriptions[:MOST_TOPICS]:
                endpoints += [Endpoint("subscription", full, topic, type_name) for type_name in types]
        graph = Graph(self.now(), tuple(sorted(nodes)), tuple(sorted(endpoints, key=str)))
        if not self.graphs or (graph.nodes, graph.endpoints) != (self.graphs[-1].nodes, self.graphs[-1].endpoints):
            self.graphs.append(graph)

    def _wanted(self, topic: str, type_name: str) -> bool:
        if len(self._known) >= MOST_TOPICS:
            return False
        if topic == "/turtle1/cmd_vel" and type_name == "geometry_msgs/msg/Twist":
            return False  # the simulator's own subscription tells it: what is judged is what moved the turtle
        # The simulator tells what it sends itself; a subscription is for those who forge it.
        return self._simulated.get(topic) != type_name or bool(self.count_publishers(topic) > 1)

    def _subscribe(self, topic: str, type_name: str) -> bool:
        message_type = self._load(type_name)
        if message_type is None:
            return False
        offers = self.get_publishers_info_by_topic(topic)

        def keep(data: bytes) -> None:
            if self.keep(topic, type_name, data) and type_name == "rcl_interfaces/msg/Log" and topic == "/rosout":
                line = deserialize_message(data, message_type)
                level = _LEVELS.get(line.level, str(line.level))
                self.log.append(LogLine(self.now(), level, line.name, line.msg))

        try:
            self.create_subscription(message_type, topic, keep, _matching(offers), raw=True)
        except Exception:
            return False
        return True

    def _load(self, type_name: str) -> Any | None:  # noqa: ANN401 - a message class
        match = _TYPE.fullmatch(type_name)
        if match is None:
            return None
        package, name = match.groups()
        if not any((prefix / "share" / package / "msg" / f"{name}.msg").is_file() for prefix in self._prefixes):
            return None
        return getattr(importlib.import_module(f"{package}.msg"), name)


def _matching(offers: list[TopicEndpointInfo]) -> QoSProfile:
    # As `ros2 bag record` does: ask for no more than every publisher offers, and for all of it.
    reliable = bool(offers) and all(o.qos_profile.reliability == ReliabilityPolicy.RELIABLE for o in offers)
    local = bool(offers) and all(o.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=1000,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if local else DurabilityPolicy.VOLATILE,
    )

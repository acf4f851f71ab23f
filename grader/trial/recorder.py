"""Recorder: record the topics of the ROS graph (up to a limit) and the graph itself, in the conductor's process."""

from __future__ import annotations

import time
from collections import Counter
from typing import TYPE_CHECKING, Any, Literal

from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

from grader.trial.interface_class import load_class
from grader.trial.observed import Offer
from grader.trial.recording import Command, Endpoint, Graph, LogLine, Message
from grader.trial.repeats import REPORTED_TYPES, Repeats

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from pathlib import Path

    from rclpy.qos import TopicEndpointInfo

OWN_NAMESPACE = "/_grader"
NAMESAKE = " (of the submission)"
"""This suffix is added to the name of a student's node if one of the grader's nodes has the same name."""
NAMELESS = "_NODE_NAME_UNKNOWN_"
"""The name that ROS 2 reports for a node whose endpoints were discovered before the node itself."""
_LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}

# A node that keeps creating topics or messages must not fill the memory of the grader.
MOST_TOPICS = 100
MOST_TYPES = 200
"""The maximum number of types on one topic."""
MOST_NODES = 100
MOST_SERVICES = 200
OF_EVERY_NODE = ("rcl_interfaces/", "type_description_interfaces/")
"""The type prefixes of the services that rclpy adds to every node, under the node's name."""
MOST_OBSERVED = 50_000
"""The maximum number of nodes and endpoints in all snapshots together."""
MOST_MESSAGES = 20_000
"""The maximum number of messages on each judged topic, and on all other topics together."""
MOST_BYTES = 32 * 1024 * 1024
MOST_JUDGED_BYTES = 4 * 1024 * 1024
"""The maximum total size (bytes) of the messages: on all topics together that are not judged, and on each judged
topic."""


class Recorder(Node):
    """A hidden node that subscribes to the topics in the graph, up to a limit.

    The recorder never subscribes to the commands for turtle1, because the simulator itself reports them. The recorder
    subscribes to the simulator's own topics for turtle1 and to /clock only if other nodes publish on them, too. A
    message that both the simulator and the recorder report is stored once.
    """

    def __init__(
        self, now: Callable[[], float], prefixes: list[Path], simulated: dict[str, str], judged: Collection[str] = ()
    ) -> None:
        """Create the node.

        `now` returns the current time on the trial's clock (s). `prefixes` are the folders in which the message types
        are installed.

        `simulated` maps the names of the simulator's topics, for which the recorder is not needed, to their types. The
        `judged` topics are always recorded, however many other topics there are.
        """
        super().__init__("recorder", namespace=OWN_NAMESPACE, start_parameter_services=False, enable_rosout=False)
        self.now = now
        self.messages: list[Message] = []
        self.commands: list[Command] = []
        self.log: list[LogLine] = []
        self.graphs: list[Graph] = []
        self.topics: dict[str, set[str]] = {}
        self.dropped = 0
        self.graph_dropped = 0
        self.follows_services = False
        self.own_nodes: tuple[str, ...] = (self.get_fully_qualified_name(),)
        """The full names of the grader's nodes: at first only the recorder. The trial adds the other nodes."""
        self._offers: set[Offer] = set()
        self._judged = frozenset(judged)
        self._subscribed: Counter[str] = Counter()
        """The number of recorded types for each judged topic. The entry for the empty string counts the types of all
        other topics together."""
        self._reported: set[tuple[str, str, str]] = set()
        self._prefixes = prefixes
        self._simulated = simulated
        self._known: set[tuple[str, str]] = set()
        self._repeats = Repeats()
        self._kept: Counter[str] = Counter()
        self._bytes: Counter[str] = Counter()
        """The number and the total size (bytes) of the messages, with the same keys as `_subscribed`."""
        self._observed = 0
        self._participant = self._own_participant()
        self._endpoints_before: dict[tuple[str, str], tuple[object, set[Endpoint]]] = {}

    def keep(self, topic: str, type_name: str, data: bytes, *, by_simulator: bool = True) -> bool:
        """Store a message that the simulator or the recorder has just received, or that the simulator has sent.

        Return False if the recording is full, or if the other of the two has already reported the message. Messages on
        other topics must not displace those on a judged topic.
        """
        doubled = type_name in REPORTED_TYPES and (topic, type_name) in self._known
        if doubled and self._repeats.is_repeat(topic, data, by_simulator=by_simulator):
            return False
        group, most_bytes = (topic, MOST_JUDGED_BYTES) if topic in self._judged else ("", MOST_BYTES)
        if self._kept[group] >= MOST_MESSAGES or self._bytes[group] + len(data) > most_bytes:
            self.dropped += 1
            return False
        self._kept[group] += 1
        self._bytes[group] += len(data)
        if doubled:
            self._repeats.add(topic, data, by_simulator=by_simulator)
        self.messages.append(Message(topic, type_name, data, self.now(), time.monotonic()))
        return True

    def keep_command(self, topic: str, data: bytes, twist: Any) -> None:  # noqa: ANN401 - a ROS message
        """Store a Twist that a turtle received. For turtle1, store it also as a command."""
        if self.keep(topic, "geometry_msgs/msg/Twist", data) and topic == "/turtle1/cmd_vel":
            last = self.messages[-1]
            linear = (twist.linear.x, twist.linear.y, twist.linear.z)
            angular = (twist.angular.x, twist.angular.y, twist.angular.z)
            self.commands.append(Command(last.t_s, last.mono_s, linear, angular))

    def nodes(self) -> list[str]:
        """Return the full names of all nodes in the graph except the recorder.

        A name that two nodes share appears twice.
        """
        found = [f"{space.rstrip('/')}/{name}" for name, space in self.get_node_names_and_namespaces()]
        found.remove(self.get_fully_qualified_name())
        return found

    def follow_graph(self) -> bool:
        """Subscribe to new topics, and to new types on known topics. Return whether a subscription was created."""
        fresh = False
        for topic, types in self.get_topic_names_and_types():
            if topic not in self.topics and len(self.topics) >= 10 * MOST_TOPICS and topic not in self._judged:
                continue
            self.topics.setdefault(topic, set()).update(types[:MOST_TYPES])
            for type_name in types:
                if (topic, type_name) not in self._known and self._wanted(topic, type_name):
                    self._known.add((topic, type_name))
                    self._subscribed[topic if topic in self._judged else ""] += 1
                    fresh |= self._subscribe(topic, type_name)
        return fresh

    @property
    def offers(self) -> tuple[Offer, ...]:
        """The services that other nodes offered when `follow_services` ran, up to a limit."""
        return tuple(sorted(self._offers, key=lambda offer: (offer.service, offer.type, offer.node)))

    def follow_services(self) -> None:
        """Store the services that other nodes offer now, except those that every node has."""
        for name, space in self.get_node_names_and_namespaces():
            node = f"{space.rstrip('/')}/{name}"
            if node in self.own_nodes or len(self._offers) >= MOST_SERVICES:
                continue
            for service, types in self.get_service_names_and_types_by_node(name, space)[:MOST_SERVICES]:
                if not service.startswith(f"{node}/") or not types[0].startswith(OF_EVERY_NODE):
                    self._offers.add(Offer(node, service, types[0]))

    def snapshot(self) -> None:
        """Store a snapshot of the current graph if the graph has changed."""
        if self.follows_services:
            self.follow_services()
        # The judged topics come first, because a hundred other topics must not crowd them out.
        types = {topic: tuple(types) for topic, types in self.get_topic_names_and_types()}
        topics = sorted((topic not in self._judged, topic) for topic in types)
        shown = [topic for beside, topic in topics if not beside]
        shown += [topic for beside, topic in topics if beside][:MOST_TOPICS]
        endpoints: set[Endpoint] = set()
        left_out = len(topics) - len(shown)
        nodes = sorted(self.nodes(), key=lambda name: (name not in self.own_nodes, name))
        if len(self._endpoints_before) > 4 * MOST_TOPICS:
            self._endpoints_before.clear()
        for topic in shown:
            for kind in ("publisher", "subscription"):
                every = self._endpoints(kind, topic, (types[topic], nodes))
                kept = _each_type_first(every)[:MOST_NODES]
                left_out += len(every) - len(kept)
                endpoints.update(kept)
        left_out += max(0, len(nodes) - MOST_NODES)
        self.graph_dropped = max(self.graph_dropped, left_out)
        self._add(Graph(self.now(), tuple(sorted(nodes[:MOST_NODES])), tuple(sorted(endpoints, key=str))))

    def _add(self, graph: Graph) -> None:
        last = self.graphs[-1] if self.graphs else None
        if last is not None and (graph.nodes, graph.endpoints) == (last.nodes, last.endpoints):
            return
        judged = [end for end in graph.endpoints if end.topic in self._judged]
        self._observed += len(graph.nodes) + len(graph.endpoints)
        if self._observed > MOST_OBSERVED:
            # The recording is full. New types on a judged topic are still stored, because there are only a few.
            self.graph_dropped += 1
            fresh = tuple(end for end in judged if (end.kind, end.topic, end.type) not in self._reported)
            graph = Graph(graph.t_s, (), fresh)
        if graph.nodes or graph.endpoints:
            self.graphs.append(graph)
        self._reported |= {(end.kind, end.topic, end.type) for end in judged}

    def _endpoints(self, kind: Literal["publisher", "subscription"], topic: str, beside: object) -> set[Endpoint]:
        """Return the endpoints of other nodes on a topic.

        Querying the endpoints takes fifty times as long as counting them. Therefore, a complete result is used again
        until their number or `beside` changes. `beside` contains the types of the topic and the nodes in the graph: if
        they have changed, the endpoints may have changed, too.
        """
        publishes = kind == "publisher"
        amount = self.count_publishers(topic) if publishes else self.count_subscribers(topic)
        known = self._endpoints_before.get((kind, topic))
        if known is not None and known[0] == (amount, beside):
            return known[1]
        found = self.get_publishers_info_by_topic(topic) if publishes else self.get_subscriptions_info_by_topic(topic)
        result = self._of_others(kind, topic, found)
        if len(found) == amount and all(info.node_name != NAMELESS for info in found):
            self._endpoints_before[kind, topic] = (amount, beside), result
        return result

    def _of_others(
        self, kind: Literal["publisher", "subscription"], topic: str, found: list[TopicEndpointInfo]
    ) -> set[Endpoint]:
        """Return the endpoints of other nodes. Nodes are identified by their participant, since names can be faked."""
        own_name = self.get_fully_qualified_name()
        result = set()
        for info in found:
            node = f"{info.node_namespace.rstrip('/')}/{info.node_name}"
            ours = _participant(info) == self._participant
            if ours and node == own_name:
                continue
            shown = node + NAMESAKE if node in self.own_nodes and not ours else node
            result.add(Endpoint(kind, shown, topic, info.topic_type))
        return result

    def _own_participant(self) -> bytes:
        """Return the id of the recorder's DDS participant.

        No other node can publish on the topic /_grader/whoami, since the student's node does not exist yet.
        """
        topic = f"{OWN_NAMESPACE}/whoami"
        publisher = self.create_publisher(Log, topic, 1)
        found = self.get_publishers_info_by_topic(topic)
        self.destroy_publisher(publisher)
        return _participant(found[0])

    def _wanted(self, topic: str, type_name: str) -> bool:
        group, most = (topic, MOST_TYPES) if topic in self._judged else ("", MOST_TOPICS)
        if self._subscribed[group] >= most:
            return False
        if topic == "/turtle1/cmd_vel" and type_name == "geometry_msgs/msg/Twist":
            return False  # the simulator reports commands: checks judge the ones that moved the turtle
        # The simulator reports its own messages. The subscription is for messages that other nodes send on its topics.
        return self._simulated.get(topic) != type_name or bool(self.count_publishers(topic) > 1)

    def _subscribe(self, topic: str, type_name: str) -> bool:
        message_type = load_class(type_name, "msg", self._prefixes)
        if message_type is None:
            return False
        offers = self.get_publishers_info_by_topic(topic)

        def keep(data: bytes) -> None:
            kept = self.keep(topic, type_name, data, by_simulator=False)
            if kept and type_name == "rcl_interfaces/msg/Log" and topic == "/rosout":
                line = deserialize_message(data, message_type)
                level = _LEVELS.get(line.level, str(line.level))
                self.log.append(LogLine(self.now(), level, line.name, line.msg))

        try:
            self.create_subscription(message_type, topic, keep, _matching(offers), raw=True)
        except Exception:
            return False
        return True


def _each_type_first(endpoints: set[Endpoint]) -> list[Endpoint]:
    """Return the endpoints in an order that begins with one endpoint of each type."""
    ordered = sorted(endpoints, key=str)
    first = list({end.type: end for end in reversed(ordered)}.values())
    return first + [end for end in ordered if end not in first]


def _participant(info: TopicEndpointInfo) -> bytes:
    # A DDS GUID has 12 bytes for the participant (the process) and 4 bytes for the endpoint within it.
    return bytes(info.endpoint_gid[:12])


def _matching(offers: list[TopicEndpointInfo]) -> QoSProfile:
    # Like `ros2 bag record`, request the strictest QoS that all publishers offer.
    reliable = bool(offers) and all(o.qos_profile.reliability == ReliabilityPolicy.RELIABLE for o in offers)
    local = bool(offers) and all(o.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=1000,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if local else DurabilityPolicy.VOLATILE,
    )

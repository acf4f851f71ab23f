"""The ROS graph as a picture: choose the nodes and topics to show, and write them as DOT or as text.

Nodes are ellipses, topics are boxes, and arrows point in the direction of the messages. A graph comes from the live
system (`grader.graph.endpoints.Observed`) or from a recording (`grader.trial.recording.Graph`).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

DEBUG_TOPICS = frozenset({"/rosout", "/rosout_agg", "/parameter_events", "/clock", "/statistics", "/diagnostics"})
"""Topics that nearly every node has, or that are meant for tools. rqt_graph calls them debug topics."""

DEBUG_NODES = ("/rqt_gui", "/rqt_graph", "/rviz", "/rosbag2_")
"""The name prefixes of nodes that belong to tools."""


class Endpoint(Protocol):
    """A publisher or subscription, such as `grader.trial.recording.Endpoint`."""

    @property
    def kind(self) -> str:
        """Either "publisher" or "subscription"."""

    @property
    def node(self) -> str:
        """The full name of the endpoint's node, such as "/draw_circle"."""

    @property
    def topic(self) -> str:
        """The full name of the endpoint's topic, such as "/turtle1/cmd_vel"."""


@dataclass(frozen=True)
class Show:
    """The parts of a graph to show, like the check boxes of the real rqt_graph."""

    debug: bool = False
    """Whether to show debug topics (such as /rosout and /clock) and the nodes that belong to tools."""
    hidden: bool = False
    """Whether to show names with a part that begins with "_", such as the topics of actions."""
    dead_ends: bool = True
    """Whether to show topics that have no subscribers or no publishers among the nodes shown."""


@dataclass(frozen=True)
class Node:
    """A node with its full name.

    `count` is greater than 1 if several nodes have the same name, which is an error.
    """

    name: str
    count: int = 1


@dataclass(frozen=True)
class Topic:
    """A topic, and the nodes shown that publish or subscribe: their full names, sorted and without duplicates."""

    name: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]

    @property
    def dead_end(self) -> bool:
        """Whether the topic has no publisher or no subscriber among the nodes shown."""
        return not (self.publishers and self.subscribers)


@dataclass(frozen=True)
class Picture:
    """The nodes and topics to draw, sorted by name so that equal graphs produce equal pictures."""

    nodes: tuple[Node, ...]
    topics: tuple[Topic, ...]

    @property
    def alone(self) -> tuple[Node, ...]:
        """The nodes that no arrow connects to a topic."""
        touched = {name for topic in self.topics for name in (*topic.publishers, *topic.subscribers)}
        return tuple(node for node in self.nodes if node.name not in touched)


def picture(nodes: Iterable[str], endpoints: Iterable[Endpoint], show: Show | None = None) -> Picture:
    """Choose the nodes (full names, one entry per node), publishers and subscriptions to show."""
    chosen = show or Show()
    ends = list(endpoints)
    counts = Counter(nodes)
    # An endpoint can be discovered before its node.
    counts.update({end.node: 1 for end in ends if end.node not in counts})
    shown = {name: count for name, count in counts.items() if _node_shown(name, chosen)}
    by_topic: dict[str, list[Endpoint]] = {}
    for end in ends:
        by_topic.setdefault(end.topic, []).append(end)
    topics = []
    for name in sorted(name for name in by_topic if _topic_shown(name, chosen)):
        at = [end for end in by_topic[name] if end.node in shown]
        publishers = sorted({end.node for end in at if end.kind == "publisher"})
        subscribers = sorted({end.node for end in at if end.kind == "subscription"})
        topic = Topic(name, tuple(publishers), tuple(subscribers))
        if at and (chosen.dead_ends or not topic.dead_end):
            topics.append(topic)
    return Picture(tuple(Node(name, shown[name]) for name in sorted(shown)), tuple(topics))


def _hidden(name: str) -> bool:
    return any(part.startswith("_") for part in name.split("/"))


def _topic_shown(name: str, show: Show) -> bool:
    return (show.hidden or not _hidden(name)) and (show.debug or name not in DEBUG_TOPICS)


def _node_shown(name: str, show: Show) -> bool:
    return (show.hidden or not _hidden(name)) and (show.debug or not name.startswith(DEBUG_NODES))


# --- DOT --------------------------------------------------------------------------------------------------------------

_HEAD = """\
digraph ros_graph {
  rankdir=%s;
  bgcolor="white";
  pad=0.2;
  nodesep=0.3;
  ranksep=0.6;
  node [label="\\N", fontname="DejaVu Sans", fontsize=12, style=filled, penwidth=1.2];
  edge [color="#37474f", arrowsize=0.8];
"""
_ELLIPSE = 'shape=ellipse, fillcolor="#e3f2fd", color="#1565c0"'
_BOX = 'shape=box, fillcolor="#fff8e1", color="#ef6c00"'


def to_dot(drawn: Picture, *, downwards: bool = False) -> str:
    """Return the graph in DOT, the language of Graphviz. Each node and each topic gets a unique name in DOT.

    Messages go from left to right, or from top to bottom if `downwards`.
    """
    names = {node.name for node in drawn.nodes}
    lines = []
    for node in drawn.nodes:
        twice = f", label={_quoted(f'{node.name}{chr(10)}({node.count} nodes of this name)')}" if node.count > 1 else ""
        lines.append(f"{_quoted(node.name)} [{_ELLIPSE}{twice}];")
    for topic in drawn.topics:
        # A topic may have the same name as a node. Without a different key, DOT would treat them as one node.
        clash = f", label={_quoted(topic.name)}" if topic.name in names else ""
        key = _quoted(f"topic {topic.name}" if clash else topic.name)
        lines.append(f"{key} [{_BOX}{clash}];")
        lines += [f"{_quoted(publisher)} -> {key};" for publisher in topic.publishers]
        lines += [f"{key} -> {_quoted(subscriber)};" for subscriber in topic.subscribers]
    return _HEAD % ("TB" if downwards else "LR") + "".join(f"  {line}\n" for line in lines) + "}\n"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


# --- text -------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Strokes:
    """The characters for the lines from publishers to a topic, and from the topic to subscribers."""

    one: str
    into: tuple[str, str, str]
    """The strokes next to the publishers of a topic with several publishers: the first, a middle one and the last."""
    out: tuple[str, str, str]


_UNICODE = _Strokes("───▶", ("─┬─▶", "─┤  ", "─┘  "), ("─┬─▶", " ├─▶", " └─▶"))
_ASCII = _Strokes("--->", ("-+->", "-+  ", "-+  "), ("-+->", " +->", " +->"))


def to_text(drawn: Picture, *, ascii_only: bool = False) -> str:
    """Return the picture for a terminal, with publishers on the left of each topic and subscribers on the right."""
    strokes = _ASCII if ascii_only else _UNICODE
    counts = {node.name: node.count for node in drawn.nodes}
    # Topics with publishers and subscribers come first, and then topics with publishers only.
    topics = sorted(drawn.topics, key=lambda topic: (topic.dead_end, not topic.publishers, topic.name))
    left = max((len(_node(name, counts)) for topic in topics for name in topic.publishers), default=0)
    middle = max((len(topic.name) + 2 for topic in topics), default=0)
    lines = [line for topic in topics for line in _rows(topic, counts, strokes, left, middle)]
    if drawn.alone:
        lines += [""] if lines else []
        lines += [f"{_node(node.name, counts)}  uses none of the topics shown" for node in drawn.alone]
    legend = f"(node) {strokes.one} [topic] {strokes.one} (node): arrows point in the direction of the messages."
    return "\n".join([*lines, "", legend]) + "\n"


def _node(name: str, counts: dict[str, int]) -> str:
    return f"({name})" + (f" x{counts[name]}" if counts.get(name, 1) > 1 else "")


def _rows(topic: Topic, counts: dict[str, int], strokes: _Strokes, left: int, middle: int) -> Iterator[str]:
    into = list(_branches(len(topic.publishers), strokes.one, strokes.into))
    out = list(_branches(len(topic.subscribers), strokes.one, strokes.out))
    space = " " * len(strokes.one)
    for row in range(max(len(into), len(out))):
        publisher = _node(topic.publishers[row], counts) if row < len(into) else ""
        subscriber = _node(topic.subscribers[row], counts) if row < len(out) else ""
        box = f"[{topic.name}]" if row == 0 else ""
        enter = into[row] if row < len(into) else space
        leave = out[row] if row < len(out) else space
        # The line to the right begins at the edge of the box, so that there is no gap.
        gap = strokes.one[0] if row == 0 and out else " "
        yield f"{publisher:>{left}} {enter} {f'{box} '.ljust(middle + 1, gap)}{leave} {subscriber}".rstrip()


def _branches(count: int, one: str, several: tuple[str, str, str]) -> Iterator[str]:
    for row in range(count):
        yield one if count == 1 else several[0] if row == 0 else several[2] if row == count - 1 else several[1]

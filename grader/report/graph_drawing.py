"""The ROS graph as SVG: publishers on the left, topics with their types in the middle, subscribers on the right.

For a narrow page there is a second picture with two columns: nodes and topics.

Unlike rqt_graph, this module does not use Graphviz for the layout. A page needs light and dark colours and must be
generated quickly, and a C library should not process names that a student chose.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import a_list, shorten
from grader.graph.graph import Topic
from grader.graph.graph import picture as choose
from grader.report.svg import coordinate, picture, tag, words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.trial.recording import Recording

WIDTH = 640.0
ROW, BOX = 62.0, 40.0
SIDE, MIDDLE = 150.0, 216.0
"""The widths of the boxes of a node and of a topic."""
MOST_TOPICS, MOST_NODES = 10, 12
NODE, TOPIC = "#1c7ed6", "#e8590c"
NARROW = 360.0
NARROW_SIDE, NARROW_MIDDLE = 124.0, 184.0
CHAR = 7.0
"""The approximate width of a character."""
ASIDE = 8.0
"""In the narrow picture, arrows in both directions end at the same side of a box, and are this far off its centre."""


@dataclass(frozen=True)
class GraphDrawing:
    """The graph as a wide picture, as a narrow one, and as rows.

    `left_out` is the number of boxes (topics and nodes) that did not fit into the wide picture.

    A row is (node, "publishes on" or "subscribes to", topic, type).
    """

    svg: str
    narrow: str
    rows: tuple[tuple[str, str, str, str], ...]
    left_out: int


def draw_graph(recording: Recording, name: str = "graph") -> GraphDrawing | None:
    """Draw the nodes and topics that were in the graph at any time, or as many of them as fit.

    Hidden names, debug topics such as /rosout, and the nodes of tools are left out. Return None if no node is left.
    """
    nodes = sorted({node for graph in recording.graphs for node in graph.nodes})
    ends = {end: None for graph in recording.graphs for end in graph.endpoints}
    graph = choose(nodes, ends)
    if not graph.nodes:
        return None
    own = set(recording.own_nodes)
    topics = sorted(graph.topics, key=lambda topic: (not _of_student(topic, own), topic.dead_end, topic.name))
    types: dict[str, list[str]] = {}
    for end in ends:
        if end.type not in types.setdefault(end.topic, []):
            types[end.topic].append(end.type)
    shown = topics[:MOST_TOPICS]
    names = {topic.name for topic in shown}
    verb = {"publisher": "publishes on", "subscription": "subscribes to"}
    rows = sorted((end.node, verb[end.kind], end.topic, end.type) for end in ends if end.topic in names)
    left = _ordered([name for topic in shown for name in topic.publishers]) + [node.name for node in graph.alone]
    right = _ordered([name for topic in shown for name in topic.subscribers])
    dropped = len(topics) - len(shown) + sum(max(len(names) - MOST_NODES, 0) for names in (left, right))
    left, right = left[:MOST_NODES], right[:MOST_NODES]
    svg = _draw(shown, types, left, right, name)
    narrow = _draw_narrow(shown, types, _ordered([*left, *right]), f"{name}-narrow")
    return GraphDrawing(svg, narrow, tuple(rows[:60]), dropped)


def _of_student(topic: Topic, own: set[str]) -> bool:
    return bool({*topic.publishers, *topic.subscribers} - own)


def _draw(topics: Sequence[Topic], types: dict[str, list[str]], left: list[str], right: list[str], name: str) -> str:
    height = max(len(left), len(right), len(topics), 1) * ROW + 34
    middle_x, right_x = (WIDTH - MIDDLE) / 2, WIDTH - SIDE - 2
    parts = [
        words(text, x, 16, "middle", font_weight="bold")
        for text, x in (("publishes", 2 + SIDE / 2), ("topic", WIDTH / 2), ("subscribes", right_x + SIDE / 2))
    ]
    lefts, rights = _places(left, height), _places(right, height)
    heights = _places([topic.name for topic in topics], height)
    for topic in topics:
        y = heights[topic.name]
        parts += [_arrow(2 + SIDE, lefts[node], middle_x, y) for node in topic.publishers if node in lefts]
        parts += [_arrow(middle_x + MIDDLE, y, right_x, rights[node]) for node in topic.subscribers if node in rights]
        parts.append(_topic(topic.name, types.get(topic.name, []), middle_x, y))
    parts += [_node(node, 2.0, y) for node, y in lefts.items()]
    parts += [_node(node, right_x, y) for node, y in rights.items()]
    return _picture(parts, topics, WIDTH, height, name)


def _draw_narrow(topics: Sequence[Topic], types: dict[str, list[str]], nodes: list[str], name: str) -> str:
    """Draw nodes on the left and topics on the right. Arrows point in the direction of the messages."""
    height = max(len(nodes), len(topics), 1) * ROW + 34
    topic_x = NARROW - NARROW_MIDDLE - 2
    node_x = 2 + NARROW_SIDE
    parts = [
        words(text, x, 16, "middle", font_weight="bold")
        for text, x in (("node", 2 + NARROW_SIDE / 2), ("topic", topic_x + NARROW_MIDDLE / 2))
    ]
    lefts, rights = _places(nodes, height), _places([topic.name for topic in topics], height)
    for topic in topics:
        y = rights[topic.name]
        out = [lefts[node] for node in topic.publishers if node in lefts]
        back = [lefts[node] for node in topic.subscribers if node in lefts]
        parts += [_arrow(node_x, place - ASIDE, topic_x, y - ASIDE) for place in out]
        parts += [_arrow(topic_x, y + ASIDE, node_x, place + ASIDE) for place in back]
        parts.append(_topic(topic.name, types.get(topic.name, []), topic_x, y, NARROW_MIDDLE))
    parts += [_node(node, 2.0, y, NARROW_SIDE) for node, y in lefts.items()]
    return _picture(parts, topics, NARROW, height, name)


def _picture(parts: Sequence[str], topics: Sequence[Topic], width: float, height: float, name: str) -> str:
    about = " ".join(
        f"Publishers on {shorten(topic.name)}: {_who(topic.publishers)}; subscribers: {_who(topic.subscribers)}."
        for topic in topics
    )
    return picture(
        *parts,
        width=width,
        height=height,
        title="The ROS graph: nodes and topics",
        about=about,
        key="graph",
        name=f"{name}-picture",
    )


def _who(names: Sequence[str]) -> str:
    return a_list([shorten(name) for name in names]) or "none"


def _ordered(names: Sequence[str]) -> list[str]:
    return list(dict.fromkeys(names))


def _places(names: Sequence[str], height: float) -> dict[str, float]:
    """Return evenly spaced y coordinates for the centres of the boxes with these names."""
    room = (height - 34) / max(len(names), 1)
    return {name: 30 + room * (index + 0.5) for index, name in enumerate(names)}


def _node(name: str, x: float, y: float, width: float = SIDE) -> str:
    shape = tag(
        "rect", x=x, y=y - BOX / 2, width=width, height=BOX, rx=BOX / 2, fill=NODE, fill_opacity=0.14, stroke=NODE
    )
    text = shorten(name, int(width / CHAR))
    return tag("g", tag("title", _plain(name)), shape, words(text, x + width / 2, y + 4.5, "middle"))


def _topic(name: str, types: Sequence[str], x: float, y: float, width: float = MIDDLE) -> str:
    shape = tag("rect", x=x, y=y - BOX / 2, width=width, height=BOX, fill=TOPIC, fill_opacity=0.12, stroke=TOPIC)
    several = f"{len(types)} types: " if len(types) > 1 else ""
    most = int(width / CHAR)
    kind = shorten(several + ", ".join(types), most + 3)
    return tag(
        "g",
        tag("title", _plain(f"{name} ({', '.join(types)})")),
        shape,
        words(shorten(name, most), x + width / 2, y - 3, "middle"),
        words(kind, x + width / 2, y + 13, "middle", font_size=11.5),
    )


def _plain(text: str) -> str:
    from html import escape

    return escape(shorten(text, 160))


def _arrow(x1: float, y1: float, x2: float, y2: float) -> str:
    bend, back = (x1 + x2) / 2, 1 if x2 > x1 else -1
    path = (
        f"M{coordinate(x1)} {coordinate(y1)}C{coordinate(bend)} {coordinate(y1)} {coordinate(bend)} {coordinate(y2)} "
        f"{coordinate(x2 - 7 * back)} {coordinate(y2)}"
    )
    tip = f"M{coordinate(x2)} {coordinate(y2)}l{-9 * back}-4.5v9z"
    return tag("path", d=path, fill="none", stroke="currentColor") + tag("path", d=tip, fill="currentColor")

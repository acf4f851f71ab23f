"""The graph for a page. Graphviz lays out the nodes, topics and arrows as in rqt_graph."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from grader.common.words import count
from grader.errors import MachineError
from grader.graph.graph import to_dot
from grader.graph.layout import render

if TYPE_CHECKING:
    from grader.graph.graph import Picture

_INCH = 72.0
"""The number of points per inch. Graphviz returns sizes in inches and positions in points, with the y axis pointing
up."""


MOST_ARROWS = 2000
"""The maximum number of arrows. It is also the maximum number of nodes, and of topics. Graphviz needs a second for this
number of arrows, and the time grows with the square of the number."""
NOTHING: dict[str, Any] = {"width": 0.0, "height": 0.0, "nodes": [], "arrows": []}
"""The layout of a graph without nodes and topics."""


def laid_out(drawn: Picture) -> dict[str, Any]:
    """Return two layouts of the graph: "wide", from left to right, and "narrow", from top to bottom.

    A layout has the size of the graph (points), its nodes and topics with centre and size, and its arrows. The points
    of an arrow are the start of a Bezier curve and three points for each segment. `tip` is the tip of the arrowhead.

    Raises:
        MachineError: Graphviz cannot draw, or the graph is too large (any program in the domain can create topics).
    """
    arrows = sum(len(topic.publishers) + len(topic.subscribers) for topic in drawn.topics)
    if max(arrows, len(drawn.nodes), len(drawn.topics)) > MOST_ARROWS:
        message = (
            f"The graph is too large to be drawn: {count(len(drawn.nodes), 'node')}, "
            f"{count(len(drawn.topics), 'topic')} and {count(arrows, 'arrow')}. Type: rqt_graph --text"
        )
        raise MachineError(message)
    return {"wide": _layout(drawn, downwards=False), "narrow": _layout(drawn, downwards=True)}


def _layout(drawn: Picture, *, downwards: bool) -> dict[str, Any]:
    if not drawn.nodes and not drawn.topics:
        return NOTHING
    made = json.loads(render(to_dot(drawn, downwards=downwards), "json0"))
    _, _, width, height = map(float, made["bb"].split(","))
    objects = made.get("objects", [])
    return {
        "width": width,
        "height": height,
        "nodes": [_node(each, height) for each in objects],
        "arrows": [_arrow(each, objects, height) for each in made.get("edges", [])],
    }


def _node(each: dict[str, Any], height: float) -> dict[str, Any]:
    x, y = map(float, each["pos"].split(","))
    return {
        "kind": "topic" if each["shape"] == "box" else "node",
        "label": each["name"] if each["label"] == "\\N" else each["label"].replace("\\n", "\n"),
        "x": x,
        "y": round(height - y, 2),
        "width": float(each["width"]) * _INCH,
        "height": float(each["height"]) * _INCH,
    }


def _arrow(each: dict[str, Any], objects: list[dict[str, Any]], height: float) -> dict[str, Any]:
    tip, *points = (part.removeprefix("e,") for part in each["pos"].split())
    return {
        "from": objects[each["tail"]]["name"],
        "to": objects[each["head"]]["name"],
        "tip": _point(tip, height),
        "points": [_point(point, height) for point in points],
    }


def _point(text: str, height: float) -> list[float]:
    x, y = map(float, text.split(","))
    return [x, round(height - y, 2)]

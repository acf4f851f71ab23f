"""The list of topics beside the graph: type, who speaks and hears, how often. Pure."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from grader.graph.graph import picture

if TYPE_CHECKING:
    from grader.graph.graph import Show
    from grader.view.state import State
    from grader.view.system import System

VIEWS = "/_view_"
"""How the names of nodes that only watch begin."""


def rows(system: System, state: State, show: Show) -> list[dict[str, object]]:
    """A row a topic that the graph shows: its types, the names at its two ends, its rate (Hz, None: silent).

    Tools with hidden names, as `ros2 topic pub`, are named too: they are why a topic speaks. Views are not.
    """
    types: dict[str, list[str]] = {}
    ends: dict[tuple[str, str], list[str]] = {}
    for end in system.heard.ends:
        if end.node.startswith(VIEWS):
            continue
        for seen, value in (
            (types.setdefault(end.topic, []), end.type),
            (ends.setdefault((end.topic, end.kind), []), end.node),
        ):
            if value not in seen:
                seen.append(value)
    drawn = picture(system.heard.nodes, system.heard.ends, show)
    rates = {**system.rates, **{topic: arrivals.hertz(time.monotonic()) for topic, arrivals in state.rates.items()}}
    return [
        {
            "name": topic.name,
            "types": types.get(topic.name, []),
            "publishers": ends.get((topic.name, "publisher"), []),
            "subscribers": ends.get((topic.name, "subscription"), []),
            "hertz": _rounded(rates.get(topic.name)),
        }
        for topic in drawn.topics
    ]


def _rounded(hertz: float | None) -> float | None:
    return None if hertz is None else float(f"{hertz:.3g}")

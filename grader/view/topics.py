"""The list of topics beside the graph: type, who speaks and hears, how often. Pure."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from grader.ros2.graph import picture

if TYPE_CHECKING:
    from grader.ros2.graph import Show
    from grader.view.state import State
    from grader.view.system import System


def rows(system: System, state: State, show: Show) -> list[dict[str, object]]:
    """A row a topic that the graph shows: its types, the names at its two ends, its rate (Hz, None: silent)."""
    types: dict[str, list[str]] = {}
    for end in system.heard.ends:
        if end.type not in types.setdefault(end.topic, []):
            types[end.topic].append(end.type)
    drawn = picture(system.heard.nodes, system.heard.ends, show)
    rates = {**system.rates, **{topic: arrivals.hertz(time.monotonic()) for topic, arrivals in state.rates.items()}}
    return [
        {
            "name": topic.name,
            "types": types[topic.name],
            "publishers": topic.publishers,
            "subscribers": topic.subscribers,
            "hertz": _rounded(rates.get(topic.name)),
        }
        for topic in drawn.topics
    ]


def _rounded(hertz: float | None) -> float | None:
    return None if hertz is None else float(f"{hertz:.3g}")

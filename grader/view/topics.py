"""The table of topics with their types, publishers, subscribers and rates."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from grader.graph.graph import picture

if TYPE_CHECKING:
    from grader.graph.graph import Show
    from grader.view.state import State
    from grader.view.system import System

VIEWS = "/_view_"
"""The prefix of the names of the hidden nodes that views create."""


def rows(system: System, state: State, show: Show) -> list[dict[str, object]]:
    """Return one row per topic in the graph: its types, publishers, subscribers and rate (Hz).

    The rate is None if no messages arrive, or if it is not measured. Tools with hidden names, such as `ros2 topic pub`,
    are also listed, since they may be the source of the messages on a topic. Views are not listed.
    """
    types: dict[str, list[str]] = {}
    ends: dict[tuple[str, str], list[str]] = {}
    for end in system.observed.ends:
        if end.node.startswith(VIEWS):
            continue
        for observed, value in (
            (types.setdefault(end.topic, []), end.type),
            (ends.setdefault((end.topic, end.kind), []), end.node),
        ):
            if value not in observed:
                observed.append(value)
    drawn = picture(system.observed.nodes, system.observed.ends, show)
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

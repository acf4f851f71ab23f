"""Updates about the ROS graph for pages: the layout of the graph, and the table of topics with their rates."""

from __future__ import annotations

import asyncio
import math
import os
import time
from typing import TYPE_CHECKING, Any

from grader.common.system_errors import refusal
from grader.errors import GraderError
from grader.graph.graph import picture
from grader.view.page_graph import NOTHING, laid_out
from grader.view.topics import rows

if TYPE_CHECKING:
    from grader.graph.graph import Show
    from grader.view.hub import Hub
    from grader.view.state import State
    from grader.view.system import System


RETRY_S = 5.0
"""If Graphviz could not draw a graph, it tries again after this time (s)."""


class GraphNews:
    """Sends the graph to all pages whenever the graph has changed. `state` has the rates that the simulator reports."""

    def __init__(self, hub: Hub, show: Show, state: State) -> None:
        self._hub = hub
        self._show = show
        self._state = state
        self._system: System | None = None
        self._graph: dict[str, Any] = {"wide": NOTHING, "narrow": NOTHING}
        self._drawn: object = None
        self._retry_s = math.inf
        self._drawing: asyncio.Task[None] | None = None

    def look(self, system: System) -> None:
        """Send the topics of the ROS system to all pages, and the graph, too, if it has changed."""
        self._system = system
        if not self._hub.pages:
            return
        self._hub.tell("topics", {"topics": self._topics()})
        if self._drawing is None or self._drawing.done():
            self._drawing = asyncio.create_task(self._draw(system))

    def whole(self) -> dict[str, object]:
        """Return the data for a new page: the domain id, and the topics and the graph if they are known."""
        known = {"topics": self._topics(), "graph": self._graph} if self._drawn is not None else {}
        return {"domain": os.environ.get("ROS_DOMAIN_ID") or "0", **known}

    async def _draw(self, system: System) -> None:
        drawn = picture(system.observed.nodes, system.observed.ends, self._show)
        if drawn == self._drawn and time.monotonic() < self._retry_s:
            return
        try:
            graph, retry_s = await asyncio.to_thread(laid_out, drawn), math.inf
        except (GraderError, OSError, RuntimeError) as error:  # a process or a thread may be refused
            problem = refusal(error) or str(error)
            graph, retry_s = {**self._graph, "problem": problem}, time.monotonic() + RETRY_S
        self._drawn, self._retry_s = drawn, retry_s
        if graph != self._graph:
            self._graph = graph
            self._hub.tell("graph", {"graph": graph})

    def _topics(self) -> list[dict[str, object]]:
        return rows(self._system, self._state, self._show) if self._system else []

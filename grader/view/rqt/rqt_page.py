"""The page of rqt: the graph, the log, a plot and a service caller, or only one of these parts."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal

from grader.graph.discovery import cli_node
from grader.graph.graph import Show
from grader.view.graph_news import GraphNews
from grader.view.guard import Door
from grader.view.hub import Hub
from grader.view.page_server import application
from grader.view.rqt.plotted import Plotted, Sample
from grader.view.rqt.rosout import Line, Lines, Rosout
from grader.view.rqt.service_caller import Answer, Service, ServiceCaller, services
from grader.view.serving import ended_by_signals, in_loop, serve
from grader.view.state import State
from grader.view.system import Ears
from grader.view.topics import VIEWS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from grader.view.address import Place
    from grader.view.system import System

Part = Literal["graph", "console", "plot", "services"]
PARTS: tuple[Part, ...] = ("graph", "console", "plot", "services")
FLUSH_S = 0.1
"""The interval at which new values and log messages are sent to the pages (s)."""
KEPT_S = 60.0
"""For pages that are opened later, this many seconds of each plot are kept, but at most _MOST_SAMPLES values."""
_TITLES: dict[Part, str] = {
    "graph": "rqt_graph",
    "console": "rqt_console",
    "plot": "rqt_plot",
    "services": "Service caller",
}
_MOST_SAMPLES = 6000
_LARGEST_REQUEST = 8000


class RqtPage:
    """Serves the page. `fields` are plotted from the start."""

    def __init__(self, parts: Sequence[Part], fields: Sequence[str] = ()) -> None:
        self._parts = parts
        self._fields = fields
        self._hub = Hub(self._whole)
        self._graph = GraphNews(self._hub, Show(), State())
        self._lines = Lines()
        self._series: dict[str, deque[Sample]] = {}
        self._wanted: dict[str, str] = {}
        self._services: list[Service] = []

    async def serve(self, place: Place, *, stays: bool) -> bool:
        """Serve until SIGINT, SIGTERM or SIGHUP arrives. Return True.

        Return False immediately if `stays` is false and the page cannot be opened in a browser.
        """
        ended, loop = ended_by_signals(), asyncio.get_running_loop()

        def tell(call: Callable[..., object]) -> Callable[..., None]:
            return lambda *arguments: in_loop(loop, call, *arguments)

        with cli_node(f"{VIEWS[1:]}{os.getpid()}") as node:
            log = Rosout(node, tell(self._logged)) if "console" in self._parts else None
            plot = Plotted(node, tell(self._plotted))
            caller = ServiceCaller(node, tell(self._answered))
            for name in self._fields:
                plot.add(name)

            def flush() -> None:
                if log is not None:
                    log.flush()
                plot.flush()
                caller.check()

            def look(system: System) -> None:
                plot.look(system.observed)
                if "graph" in self._parts:
                    in_loop(loop, self._graph.look, system)
                if "services" in self._parts:
                    in_loop(loop, self._offered, services(node))

            node.create_timer(FLUSH_S, flush)
            looking = "graph" in self._parts
            with Ears(node, look, looking=lambda: looking and self._hub.pages > 0) as ears:
                door = Door(place.address.token)
                title = _TITLES[self._parts[0]] if len(self._parts) == 1 else "rqt"
                app = application(self._hub, _Controls(ears, plot, caller), door, title, index="rqt.html")
                return await serve(place, app, door, self._hub, ended, stays=stays)

    def _logged(self, lines: list[Line]) -> None:
        self._lines.add(lines)
        self._hub.tell("log", {"log": lines})

    def _plotted(self, new: dict[str, list[Sample]], wanted: dict[str, str]) -> None:
        self._wanted = wanted
        for name in [name for name in self._series if not any(f"{name}/".startswith(f"{each}/") for each in wanted)]:
            del self._series[name]
        for name, samples in new.items():
            kept = self._series.setdefault(name, deque(maxlen=_MOST_SAMPLES))
            kept += samples
            while kept and kept[0][0] < samples[-1][0] - KEPT_S:
                kept.popleft()
        self._hub.tell("plot", {"plot": {"wanted": wanted, "new": new}})

    def _offered(self, offered: list[Service]) -> None:
        if offered != self._services:
            self._services = offered
            self._hub.tell("services", {"services": offered})

    def _answered(self, answer: Answer) -> None:
        self._hub.tell("answer", {"answer": answer})

    def _whole(self) -> dict[str, object]:
        return {
            "parts": list(self._parts),
            **self._graph.whole(),
            "log": self._lines.all(),
            "plot": {"wanted": self._wanted, "whole": {name: list(kept) for name, kept in self._series.items()}},
            "services": self._services,
        }


class _Controls:
    """Passes the users' input to the thread of the node."""

    def __init__(self, ears: Ears, plot: Plotted, caller: ServiceCaller) -> None:
        self._ears = ears
        self._plot = plot
        self._caller = caller

    def receive(self, _: object, said: dict[str, Any]) -> bool:
        """Handle a message from a page: add a field to the plot, remove a field, or call a service."""
        if "plot" in said:
            self._ears.later(self._plot.add, str(said["plot"])[:_LARGEST_REQUEST])
        elif "unplot" in said:
            self._ears.later(self._plot.remove, str(said["unplot"]))
        elif "call" in said:
            with suppress(KeyError):
                words = [str(said["call"][key]) for key in ("id", "name", "type", "request")]
                self._ears.later(self._caller.call, *words)
        return False

    def let_go(self, _: object) -> None:
        """Do nothing, since this page does not use held keys."""

    def gone(self, _: object) -> None:
        """Do nothing, since no state belongs to a single page."""

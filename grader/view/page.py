"""The process that serves the page. It reads from the simulator and from ROS, and handles the requests of the pages."""

from __future__ import annotations

import asyncio
import json
import os
import signal
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import uvicorn

from grader.errors import GraderError
from grader.graph.discovery import cli_node
from grader.graph.graph import Show, picture
from grader.view import browser
from grader.view.controls import Hands
from grader.view.feed import LARGEST
from grader.view.guard import Door
from grader.view.hub import Hub
from grader.view.page_graph import laid_out
from grader.view.page_server import application
from grader.view.state import State
from grader.view.system import Ears
from grader.view.topics import VIEWS, rows

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Iterator

    from grader.view.address import Place
    from grader.view.system import System

_RECONNECTS_S = 2.0
"""How long a tab that is still open from an earlier view needs to reconnect."""
_TIMES = 20
_SETTINGS: dict[str, Any] = {
    "log_level": "warning",
    "access_log": False,
    "ws": "websockets-sansio",
    # Compression would only waste time, since the page is on the same machine.
    "ws_per_message_deflate": False,
    "ws_max_size": 65536,
    "lifespan": "off",
    "timeout_graceful_shutdown": 1,
}


class Page:
    """The view of a simulator, or of the graph alone."""

    def __init__(self, feed: socket.socket | None, show: Show | None = None) -> None:
        self._feed = feed
        self._show = show or Show()
        self._state = State()
        self._system: System | None = None
        self._graph: dict[str, Any] = {"width": 0.0, "height": 0.0, "nodes": [], "arrows": []}
        self._drawn: object = None
        self._drawing: asyncio.Task[None] | None = None
        self._hub = Hub(self._whole)
        self._ended = asyncio.Event()

    async def serve(self, place: Place) -> bool:
        """Serve until the simulator exits, or until Ctrl-C; return whether the page could be opened in a browser.

        Without a simulator, return immediately if the page cannot be opened.
        """
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self._ended.set)
        with (
            cli_node(f"{VIEWS[1:]}{os.getpid()}") as node,
            Ears(node, lambda system: _in(loop, self._look, system), lambda: list(self._state.rates)) as ears,
        ):
            self._ears = ears
            door = Door(place.address.token)
            app = application(self._hub, Hands(ears, self._state, self._feed), door)
            server = _Server(uvicorn.Config(app, **_SETTINGS))
            serving = asyncio.create_task(server.serve([place.listening]))
            ended = asyncio.create_task(self._ended.wait())
            opening = asyncio.create_task(self._open(place, door))
            if self._feed is not None:
                self._feed.settimeout(0.0)
                loop.add_reader(self._feed, self._hear)
            try:
                opened = True
                if self._feed is None:
                    await asyncio.wait([opening, ended, serving], return_when=asyncio.FIRST_COMPLETED)
                    opened = not opening.done() or opening.result()
                if opened:
                    await asyncio.wait([ended, serving], return_when=asyncio.FIRST_COMPLETED)
            finally:
                server.should_exit = True
                await serving
        return opened

    async def _open(self, place: Place, door: Door) -> bool:
        """Open the page if there is a browser, unless a tab from an earlier view reconnects."""
        for _ in range(_TIMES if place.before else 0):
            if self._hub.pages:
                return True
            await asyncio.sleep(_RECONNECTS_S / _TIMES)
        return await asyncio.to_thread(browser.open_page, replace(place.address, token=door.code()).url)

    # --- the simulator ------------------------------------------------------------------------------------------

    def _hear(self) -> None:
        assert self._feed is not None
        while True:
            try:
                data = self._feed.recv(LARGEST)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            if not data:
                asyncio.get_running_loop().remove_reader(self._feed)
                self._ended.set()
                return
            self._hub.tell("frame", self._state.take(json.loads(data)))

    # --- the system ---------------------------------------------------------------------------------------------

    def _look(self, system: System) -> None:
        self._system = system
        self._ears.looking = self._hub.pages > 0
        if not self._hub.pages:
            return
        self._hub.tell("topics", {"topics": self._topics()})
        if self._drawing is None or self._drawing.done():
            self._drawing = asyncio.create_task(self._draw(system))

    async def _draw(self, system: System) -> None:
        drawn = picture(system.observed.nodes, system.observed.ends, self._show)
        if drawn == self._drawn:
            return
        try:
            self._graph = await asyncio.to_thread(laid_out, drawn)
        except GraderError as error:
            self._graph = {**self._graph, "problem": str(error)}
        self._drawn = drawn
        self._hub.tell("graph", {"graph": self._graph})

    def _topics(self) -> list[dict[str, object]]:
        return rows(self._system, self._state, self._show) if self._system else []

    def _whole(self) -> dict[str, object]:
        return {
            **(self._state.whole() if self._feed is not None else {}),
            "simulator": self._feed is not None,
            "domain": os.environ.get("ROS_DOMAIN_ID", "0"),
            "topics": self._topics(),
            "graph": self._graph,
        }


class _Server(uvicorn.Server):
    """A uvicorn server that lets its caller handle the signals."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Capture no signals."""
        yield


def _in(loop: asyncio.AbstractEventLoop, call: Callable[[System], None], system: System) -> None:
    # The loop may have been closed already.
    with suppress(RuntimeError):
        loop.call_soon_threadsafe(call, system)

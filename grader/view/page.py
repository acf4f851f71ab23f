"""The process that serves the page.

The process also reads from the simulator and ROS, and handles the requests that pages send.
"""

from __future__ import annotations

import asyncio
import json
import os
from typing import TYPE_CHECKING

from grader.graph.discovery import cli_node
from grader.graph.graph import Show
from grader.view.controls import Hands
from grader.view.feed import LARGEST
from grader.view.graph_news import GraphNews
from grader.view.guard import Door
from grader.view.hub import Hub
from grader.view.page_server import application
from grader.view.rqt.rosout import Line, Lines, Rosout
from grader.view.serving import ended_by_signals, in_loop, serve
from grader.view.state import State
from grader.view.system import Ears
from grader.view.topics import VIEWS

if TYPE_CHECKING:
    import socket

    from rclpy.node import Node

    from grader.view.address import Place
    from grader.view.system import System


class Page:
    """The view of a simulator, or of the graph only."""

    def __init__(self, feed: socket.socket | None, show: Show | None = None, *, stays: bool = False) -> None:
        self._feed = feed
        self._stays = stays or feed is not None
        self._state = State()
        self._hub = Hub(self._whole)
        self._news = GraphNews(self._hub, show or Show(), self._state)
        self._rosout: Rosout | None = None
        self._lines = Lines()

    async def serve(self, place: Place) -> bool:
        """Serve until the simulator exits or Ctrl-C is pressed. Return True.

        Return False immediately if there is no simulator, `stays` is false, and the page cannot be opened in a browser.
        """
        self._ended = ended_by_signals()
        loop = asyncio.get_running_loop()

        def look(system: System) -> None:
            in_loop(loop, self._news.look, system)
            if self._rosout is not None:
                self._rosout.flush()

        def listen(node: Node) -> None:
            """Subscribe to /rosout in the node's thread.

            This is done only on request, since the subscription is visible in the graph.
            """
            if self._rosout is None:
                self._rosout = Rosout(node, lambda lines: in_loop(loop, self._logged, lines))

        with (
            cli_node(f"{VIEWS[1:]}{os.getpid()}") as node,
            Ears(
                node,
                look,
                looking=lambda: self._hub.pages > 0,
                known=lambda: list(self._state.rates),
            ) as ears,
        ):
            door = Door(place.address.token)
            hands = Hands(ears, self._state, self._feed, listen=lambda: ears.later(listen, node))
            app = (
                application(self._hub, hands, door, "turtlesim")
                if self._feed is not None
                else application(self._hub, hands, door, "The ROS graph", parts="graph-only")
            )
            if self._feed is not None:
                self._feed.settimeout(0.0)
                loop.add_reader(self._feed, self._hear)
            return await serve(place, app, door, self._hub, self._ended, stays=self._stays)

    def _logged(self, lines: list[Line]) -> None:
        self._lines.add(lines)
        self._hub.tell("log", {"log": lines})

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

    def _whole(self) -> dict[str, object]:
        return {
            **(self._state.whole() if self._feed is not None else {}),
            "simulator": self._feed is not None,
            "log": self._lines.all(),
            **self._news.whole(),
        }

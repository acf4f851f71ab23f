"""Updates about the graph for pages."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import pytest

from grader.errors import MachineError
from grader.graph.endpoints import End, Observed
from grader.graph.graph import Show
from grader.tests.waiting import HANG_S
from grader.view import graph_news
from grader.view.graph_news import GraphNews
from grader.view.hub import Hub
from grader.view.page_graph import laid_out
from grader.view.state import State
from grader.view.system import System

if TYPE_CHECKING:
    from grader.graph.graph import Picture

NODE = System(Observed(("/talker",), (End("publisher", "/talker", "/chatter", "std_msgs/msg/String"),)), {})


@pytest.mark.parametrize(
    ("error", "problem"),
    [(MachineError("no room"), "no room"), (BlockingIOError(11, "Resource temporarily unavailable"), "processes")],
)
def test_a_graph_that_could_not_be_drawn_is_drawn_later(
    error: Exception, problem: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(graph_news, "RETRY_S", 0.0)
    errors = [error]

    def draw(drawn: Picture) -> dict[str, Any]:
        if errors:
            raise errors.pop()
        return laid_out(drawn)

    monkeypatch.setattr(graph_news, "laid_out", draw)
    first, second = asyncio.run(asyncio.wait_for(two_updates(), HANG_S))
    assert problem in first["problem"]
    assert "problem" not in second
    assert len(second["wide"]["nodes"]) == 2


async def two_updates() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the first two graphs that a page receives while the ROS system does not change."""
    texts: asyncio.Queue[str] = asyncio.Queue()
    hub = Hub(dict)
    news = GraphNews(hub, Show(), State())
    following = asyncio.create_task(hub.follow(texts.put))
    await texts.get()
    graphs: list[dict[str, Any]] = []
    while len(graphs) < 2:
        news.look(NODE)
        message = json.loads(await texts.get())
        graphs += [message["graph"]] if message["kind"] == "graph" else []
    following.cancel()
    return graphs[0], graphs[1]

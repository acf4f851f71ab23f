"""A hostile program in the domain can neither stop the live view nor use up its memory."""

from __future__ import annotations

import json
import shlex
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.errors import MachineError
from grader.graph.graph import Node, Picture, Topic
from grader.open.turtle_relay import LARGEST
from grader.tests.ros2.test_hostile_names import NAMED, NOT_UTF8
from grader.tests.view.tab import VIEW, live
from grader.tests.waiting import HANG_S
from grader.view import page_graph

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from websockets.sync.client import ClientConnection

    from grader.tests.ros2.world import World

SEVERAL_LOOKS_S = 2.0
"""The view looks at the graph five times in this time (s)."""
PYTHON = shlex.quote(sys.executable)
FLOOD = """
import time

import rclpy
from rcl_interfaces.msg import Log
from rclpy.qos import QoSDurabilityPolicy, QoSProfile

rclpy.init()
node = rclpy.create_node("flood", enable_rosout=False)
log = node.create_publisher(Log, "/rosout", QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL))
long = "\\N{TURTLE}" * 100_000
for name in ("first", *[long] * 30):
    while not node.count_subscribers("/rosout"):
        time.sleep(0.1)
    log.publish(Log(level=20, name=name, msg=long, file=long, function=long))
    time.sleep(0.05)
for _ in range(600):
    log.publish(Log(level=20, name="last", msg=long))
print("sent", flush=True)
rclpy.spin(node)
"""


@contextmanager
def linked(world: World) -> Iterator[ClientConnection]:
    """Connect to the live view as its page does. The view may still be starting."""
    host, _, path = live(world)
    with connect(path, origin=Origin(f"http://{host}"), max_size=LARGEST, open_timeout=HANG_S) as link:
        yield link


def message(link: ClientConnection, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Return the next message that is wanted."""
    while True:
        received: dict[str, Any] = json.loads(link.recv(HANG_S))
        if wanted(received):
            return received


def test_endless_log_messages_are_cut(fresh: World) -> None:
    fresh.start(VIEW, "Spawning turtle")
    script = fresh.home / "flood.py"
    script.write_text(FLOOD, "utf-8")
    with linked(fresh) as link:
        link.send('{"log": true}')
        fresh.start(f"{PYTHON} {script}", "sent")
        message(link, lambda news: any(line["node"] == "last" for line in news.get("log", [])))
        with linked(fresh) as another:
            whole = message(another, lambda news: news["kind"] == "all")
    assert whole["log"][-1]["node"] == "last"
    assert max(len(line["node"] + line["where"]) for line in whole["log"]) < 1000


def test_a_name_that_is_not_utf8_does_not_end_the_view(fresh: World) -> None:
    fresh.start(VIEW, "Spawning turtle")
    hostile = fresh.start(f"{PYTHON} {NAMED} {NOT_UTF8.hex()}", "announced")
    time.sleep(SEVERAL_LOOKS_S)
    with linked(fresh) as link:
        hostile.stop()
        fresh.start(f"{PYTHON} {NAMED} {b'another'.hex()}", "announced")
        message(link, lambda news: any(row["name"] == "/words" for row in news.get("topics", [])))
    assert not any("Traceback" in line for line in fresh.running[0].lines)


def test_a_message_of_brackets_does_not_end_a_connection(fresh: World) -> None:
    fresh.start(VIEW, "Spawning turtle")
    with linked(fresh) as link:
        link.send("[" * 9000)
        for _ in range(50):
            message(link, lambda news: news["kind"] == "frame")
    assert not any("Traceback" in line for line in fresh.running[0].lines)


def test_a_graph_that_is_too_large_is_not_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page_graph, "render", lambda *_: pytest.fail("Graphviz was started"))
    names = tuple(f"/node{number}" for number in range(50))
    topics = tuple(Topic(f"/topic{number}", names, ()) for number in range(page_graph.MOST_ARROWS // 50 + 1))
    with pytest.raises(MachineError, match="The graph is too large to be drawn: 50 nodes, 41 topics and 2050 arrows"):
        page_graph.laid_out(Picture(tuple(map(Node, names)), topics))
    topics = tuple(Topic(f"/topic{number}", ("/one",), ()) for number in range(page_graph.MOST_ARROWS + 1))
    with pytest.raises(MachineError, match="too large to be drawn: 1 node, 2001 topics and 2001 arrows"):
        page_graph.laid_out(Picture((Node("/one"),), topics))

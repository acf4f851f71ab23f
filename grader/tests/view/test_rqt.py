"""rqt, rqt_console and rqt_plot with a running turtlesim, in the system's Chromium, as a user starts them."""

from __future__ import annotations

import re
import urllib.request
from functools import partial
from typing import TYPE_CHECKING

import pytest

from grader.tests.both_worlds import of_the_wheels
from grader.tests.browser import violations
from grader.tests.narrow import cut
from grader.tests.ros2.world import SOLUTION, World, world
from grader.tests.view.tab import opened, url
from grader.tests.waiting import until
from grader.view.rqt.plot_fields import expand, topic_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

DRAW_CIRCLE = f"python3 {SOLUTION}/my_robot_controller/draw_circle.py"
pytestmark = of_the_wheels
"""A sourced ROS 2 has its own rqt with windows."""
KEEPS_SOCKETS = """
window.sockets = [];
window.WebSocket = class extends WebSocket {
  constructor(...given) { super(...given); sockets.push(this); }
};
"""


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    for made in world(tmp_path_factory.mktemp("rqt")):
        made.turtlesim()
        made.start(DRAW_CIRCLE, "Draw")
        yield made


def page_of(driven: World, browser: Browser, command: str) -> Iterator[Page]:
    running = driven.start(command, " until Ctrl-C.")
    tab = opened(browser, url(running))
    yield tab
    tab.close()
    assert running.stop() == 0


@pytest.fixture(scope="module")
def whole(driven: World, browser: Browser) -> Iterator[Page]:
    yield from page_of(driven, browser, "rqt")


@pytest.mark.parametrize(
    ("typed", "fields"),
    [
        ("/turtle1/pose/x", ["/turtle1/pose/x"]),
        ("turtle1/pose/x", ["/turtle1/pose/x"]),
        ("/turtle1/pose/x:y:theta", ["/turtle1/pose/x", "/turtle1/pose/y", "/turtle1/pose/theta"]),
        ("/a/x, /b/y", ["/a/x", "/b/y"]),
        ("", []),
    ],
)
def test_what_a_user_types_is_a_list_of_fields(typed: str, fields: list[str]) -> None:
    assert expand(typed) == fields


def test_the_longest_topic_with_which_a_field_begins_is_its_topic() -> None:
    assert topic_of("/a/b/c", ["/a", "/a/b", "/a/bc"]) == "/a/b"
    assert topic_of("/ab/c", ["/a"]) is None


def test_rqt_plot_shows_values_and_says_what_cannot_be_plotted(driven: World, browser: Browser) -> None:
    for tab in page_of(driven, browser, "rqt_plot /turtle1/pose/x:y"):
        tab.get_by_role("img", name="/turtle1/pose/x, /turtle1/pose/y over the last 30 seconds").wait_for()
        # The turtle drives a circle, so its y changes.
        tab.wait_for_function("""() => {
            const [, low, high] = [...document.querySelectorAll('[data-name="/turtle1/pose/y"] td.rate')].map(
                (cell) => Number(cell.textContent));
            return high > low + 0.5;
        }""")
        for field, problem in [
            ("/turtle1/pose/z", "has no attribute 'z'"),
            ("/nowhere/x", "Waiting for a publisher of this topic."),
            ("/rosout/name", "'name' is not a number"),
        ]:
            tab.get_by_label("Field", exact=True).fill(field)
            tab.get_by_role("button", name="Add").click()
            tab.get_by_role("row", name=field).get_by_text(problem).wait_for()
        # A person holds a mouse button for longer than it takes to draw the plot again.
        remove = tab.get_by_role("button", name="Remove /turtle1/pose/x")
        remove.hover()
        tab.mouse.down()
        drawn_again(tab)
        # Meanwhile, another row appears.
        tab.evaluate("document.querySelector('#field').value = '/nowhere/y'")
        tab.get_by_role("button", name="Add").evaluate("(button) => button.click()")
        tab.get_by_role("row", name="/nowhere/y").wait_for()
        assert remove.evaluate("(button) => button === document.activeElement")
        tab.mouse.up()
        tab.get_by_role("row", name="/turtle1/pose/x").wait_for(state="detached")
        assert tab.get_by_role("heading", name="Console").count() == 0


def drawn_again(tab: Page) -> None:
    """Wait until the plot has been replaced twice."""
    for _ in range(2):
        tab.evaluate("() => { window.before = document.querySelector('path.series[data-name]'); }")
        tab.wait_for_function("() => document.querySelector('path.series[data-name]') !== window.before")


def test_a_message_is_plotted_with_all_its_numbers(whole: Page) -> None:
    whole.get_by_label("Field", exact=True).fill("/turtle1/cmd_vel")
    whole.get_by_role("button", name="Add").click()
    row = whole.get_by_role("row", name="/turtle1/cmd_vel/angular/z")
    row.get_by_role("cell", name="1", exact=True).first.wait_for()
    whole.get_by_role("button", name="Remove /turtle1/cmd_vel/linear/y").click()
    row.wait_for(state="detached")


def test_rqt_console_shows_what_nodes_log_and_filters_it(driven: World, browser: Browser) -> None:
    for tab in page_of(driven, browser, "ros2 run rqt_console rqt_console"):
        log = tab.get_by_role("group", name="The log messages as a table")
        # The node of the fixture has the same text, and its message is kept for 10 s for nodes that subscribe later.
        node = driven.start(f"{DRAW_CIRCLE} --ros-args -r __node:=second", "Draw")
        log.get_by_role("row", name="Info second Draw circle node has been started").wait_for()
        node.stop()
        driven.run("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0, name: anna}'")
        log.get_by_text("Spawning turtle [anna]").wait_for()
        driven.run("ros2 service call /kill turtlesim/srv/Kill '{name: anna}'")
        tab.get_by_label("Node", exact=True).select_option("turtlesim")
        log.get_by_text("Draw circle node has been started").first.wait_for(state="detached")
        driven.run("ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 50.0}'")
        warned = log.get_by_role("row", name="Warn turtlesim Oh no! I hit the wall!")
        warned.first.wait_for()
        tab.get_by_label("Warn").uncheck()
        warned.first.wait_for(state="detached")
        tab.get_by_label("Text").fill("SPAWNING turtle [anna]")
        assert log.get_by_role("row").count() == 2  # the header and one message
        hidden = re.compile(r"^1 message, \d+ hidden by the filters\.$")
        tab.get_by_role("status").filter(has_text=hidden).wait_for()
        assert tab.title() == "rqt_console, live"


def test_cleared_messages_do_not_come_back_when_the_page_connects_again(driven: World, browser: Browser) -> None:
    for tab in page_of(driven, browser, "rqt_console"):
        tab.add_init_script(KEEPS_SOCKETS)
        tab.reload()
        log = tab.get_by_role("group", name="The log messages as a table")
        driven.run("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0, name: ben}'")
        log.get_by_text("Spawning turtle [ben]").wait_for()
        tab.get_by_role("button", name="Clear").click()
        tab.evaluate("sockets.at(-1).close()")
        until(partial(tab.evaluate, "sockets.length === 2 && sockets[1].readyState === WebSocket.OPEN"))
        driven.run("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0, name: cleo}'")
        log.get_by_text("Spawning turtle [cleo]").wait_for()
        assert log.get_by_text("Spawning turtle [ben]").count() == 0
    for name in ("ben", "cleo"):
        driven.run(f"ros2 service call /kill turtlesim/srv/Kill '{{name: {name}}}'")


def test_a_field_that_is_added_without_a_connection_is_plotted_later(driven: World, browser: Browser) -> None:
    for tab in page_of(driven, browser, "rqt_plot /turtle1/pose/x"):
        tab.add_init_script(KEEPS_SOCKETS)
        tab.reload()
        tab.get_by_role("row", name="/turtle1/pose/x").wait_for()
        tab.get_by_label("Field", exact=True).fill("/turtle1/pose/y")
        tab.evaluate("sockets[0].close(); document.querySelector('#add').requestSubmit()")
        tab.get_by_role("row", name="/turtle1/pose/y").wait_for()
        assert tab.evaluate("sockets.length") == 2


def test_a_service_is_called_from_the_page(driven: World, whole: Page) -> None:
    whole.get_by_label("Service", exact=True).select_option("/spawn")
    assert whole.get_by_label("Request").input_value() == "x: 0.0\ny: 0.0\ntheta: 0.0\nname: ''"
    whole.get_by_label("Request").fill("{x: 2.0, y: 2.0, theta: 0.0, name: leo}")
    whole.get_by_role("button", name="Call").click()
    whole.get_by_text("/spawn has responded.").wait_for()
    assert whole.get_by_role("group", name="Response").inner_text() == "name: leo"
    whole.locator('#graph [data-name="/leo/pose"]').wait_for()
    whole.get_by_label("Request").fill("{x: two}")
    whole.get_by_role("button", name="Call").click()
    whole.get_by_text("The call to /spawn failed.").wait_for()
    assert "The field 'x' has the type float." in whole.get_by_role("group", name="Response").inner_text()
    whole.get_by_label("Service", exact=True).select_option("/leo/set_pen")
    driven.run("ros2 service call /kill turtlesim/srv/Kill '{name: leo}'")
    whole.locator('option[value="/leo/teleport_absolute"]').wait_for(state="detached")
    whole.get_by_role("button", name="Call").click()
    whole.get_by_text("/leo/set_pen is not in the graph.").wait_for()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(whole: Page, scheme: str) -> None:
    whole.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    whole.get_by_role("row", name="turtlesim").first.wait_for()
    assert violations(whole) == []


def test_on_a_phone_nothing_is_cut(whole: Page) -> None:
    whole.get_by_role("row", name="turtlesim").first.wait_for()
    # A graph with more turtles than one scrolls on a phone.
    for gone in ("anna", "leo"):
        whole.locator(f'#graph [data-name^="/{gone}/"]').first.wait_for(state="detached")
    assert cut(whole) == []


def test_over_ssh_the_line_that_leads_to_the_page_is_printed(driven: World) -> None:
    for command in ("rqt_graph --port 0", "rqt"):
        ssh = "SSH_CONNECTION='10.0.0.2 50000 10.0.0.9 22' USER=anna"
        running = driven.start(f"env {ssh} {command}", "ssh -N -L ")
        port = url(running).partition("#")[0].rstrip("/").rpartition(":")[2]
        assert running.lines[-1].endswith(f"ssh -N -L {port}:127.0.0.1:{port} anna@10.0.0.9")
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/") as response:
            assert response.status == 200
        assert running.stop() == 0


def test_wrong_use_ends_with_one_sentence(driven: World) -> None:
    done = driven.run("rqt_plot --port 70000")
    assert (done.code, done.stdout) == (2, "")
    assert done.stderr.startswith("rqt_plot: --port 70000 is not available: ")
    assert len(done.stderr.splitlines()) == 1

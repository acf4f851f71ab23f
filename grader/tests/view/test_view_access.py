"""Only the page with the right address may connect to the live view. Pages of other sites must not connect."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING, Any

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.tests.browser import new_page
from grader.tests.view.tab import VIEW, address, live, opened, url
from grader.tests.waiting import HANG_S, until

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from grader.tests.ros2.world import World


def test_with_the_right_host_origin_and_token_one_comes_in(system: World) -> None:
    host, _, path = live(system)
    with connect(path, origin=Origin(f"http://{host}"), open_timeout=HANG_S) as link:  # the view may be starting
        assert '"kind":"all"' in str(link.recv())


@pytest.mark.parametrize(
    "wrong",
    [
        {"origin": "http://evil.example"},
        {"origin": "http://localhost:1"},
        {"origin": None},
        {"name": "evil.example"},
        {"token": "x" * 22},
        {"token": ""},
    ],
    ids=["foreign origin", "other port", "no origin", "rebound name", "wrong token", "no token"],
)
def test_a_connection_with_a_wrong_origin_host_or_token_is_refused(system: World, wrong: dict[str, Any]) -> None:
    wrong = dict(wrong)
    host, token, path = live(system)
    port = host.partition(":")[2]
    # After DNS rebinding, a foreign host name leads to this machine.
    name = f"{wrong.pop('name')}:{port}" if "name" in wrong else host
    requested = {"origin": f"http://{name}", "sock": socket.create_connection(("127.0.0.1", int(port))), **wrong}
    path = path.replace(host, name).replace(token, str(requested.pop("token", token)))
    with pytest.raises(InvalidStatus) as refused, connect(path, **requested, open_timeout=HANG_S):
        pass
    assert refused.value.response.status_code == 403


def test_a_foreign_page_can_neither_read_nor_drive(browser: Browser, system: World) -> None:
    host, _, path = live(system)
    tab = new_page(browser)
    tab.route("http://evil.example/", lambda route: route.fulfill(body="<p>evil</p>", content_type="text/html"))
    tab.goto("http://evil.example/")
    opens = """way => new Promise(resolve => {
        const link = new WebSocket(way);
        link.onopen = () => resolve("open");
        link.onerror = () => resolve("refused");
    })"""
    assert tab.evaluate(opens, path) == "refused"
    reads = "address => fetch(address).then(answer => answer.text(), () => 'refused')"
    assert tab.evaluate(reads, f"http://{host}/") == "refused"
    framed = """address => new Promise(resolve => {
        const frame = document.createElement("iframe");
        frame.onload = () => resolve(frame.contentDocument === null ? "sealed" : "open");
        frame.src = address;
        document.body.append(frame);
    })"""
    assert tab.evaluate(framed, f"http://{host}/") == "sealed"
    tab.close()


def test_a_page_with_a_wrong_token_says_what_to_do(browser: Browser, system: World) -> None:
    tab = new_page(browser)
    tab.goto(address(system)[:-3] + "xyz")
    tab.get_by_text("This is not the address of the running simulator.").wait_for()
    tab.close()


def test_the_browser_is_opened_with_a_code_for_which_it_gets_the_token(browser: Browser, fresh: World) -> None:
    """Every user of the machine can read command lines, so the token must not be in a command line."""
    program = fresh.home / "xdg-open"
    program.write_text(f'#!/bin/sh\necho "$1" > {fresh.home}/opened\n')
    program.chmod(0o755)
    screen = {"DISPLAY": ":0", "PATH": f"{fresh.home}:{fresh.env['PATH']}"}
    simulator = fresh.start(VIEW, "Spawning turtle", **screen)
    until(lambda: (fresh.home / "opened").exists() and bool((fresh.home / "opened").read_text()))
    address = (fresh.home / "opened").read_text().strip()
    assert address != url(simulator)
    tab = opened(browser, address)
    tab.wait_for_url(url(simulator), timeout=1000 * HANG_S)  # tab.url changes only while Playwright handles events
    second = new_page(browser)
    second.goto(address)
    second.get_by_text("This is not the address of the running simulator.").wait_for()
    second.close()
    tab.close()

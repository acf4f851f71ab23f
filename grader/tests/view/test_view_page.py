"""Test the page in the system's Chromium, with turtlesim_node --view on the real ROS 2."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from grader.tests.browser import new_page, violations
from grader.tests.narrow import cut
from grader.tests.ros2.world import SOLUTION
from grader.tests.view.tab import VIEW, address, drawn, live, opened, turtle, url
from grader.tests.waiting import until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from grader.tests.ros2.world import World

FEW = 60
"""The approximate colour of pixels at the turtle's edge."""
DRAW_CIRCLE = f"python3 {SOLUTION}/my_robot_controller/draw_circle.py"


# --- display ----------------------------------------------------------------------------------------------------------


def test_the_turtle_is_observed_to_move_and_the_graph_shows_who_moves_it(page: Page, system: World) -> None:
    before = turtle(page)
    assert drawn(page) < FEW
    node = system.start(DRAW_CIRCLE, "Draw")
    until(lambda: drawn(page) > 400)
    assert turtle(page) != before
    for begin, end in (("/draw_circle", "/turtle1/cmd_vel"), ("/turtle1/cmd_vel", "/turtlesim")):
        page.locator(f'.arrow.flows[data-from="{begin}"][data-to="{end}"]').wait_for()
    row = page.locator('[data-topic="/turtle1/cmd_vel"]')
    row.get_by_text("geometry_msgs/msg/Twist").wait_for()
    assert row.locator("td").nth(1).inner_text() == "/draw_circle"
    assert row.locator("td").nth(2).inner_text() == "/turtlesim"
    page.locator('[data-topic="/turtle1/cmd_vel"] .rate', has_text=re.compile(r"^(1\.\d+|2|2\.\d+) Hz$")).wait_for()
    page.locator('[data-topic="/turtle1/pose"] .rate', has_text=re.compile(r"^[3-6]\d(\.\d)? Hz$")).wait_for()
    page.get_by_role("img", name="Linear: linear.x 2.00 m/s").wait_for()
    page.get_by_role("img", name="Angular: angular.z 1.00 rad/s").wait_for()
    node.stop()
    page.locator('.node[data-name="/draw_circle"]').wait_for(state="detached")


@pytest.mark.exhaustive
def test_several_turtles_their_pens_and_the_background_are_observed(page: Page, system: World) -> None:
    system.run("ros2 service call /spawn turtlesim/srv/Spawn '{x: 2.0, y: 2.0, theta: 1.5, name: leo}'")
    page.locator('.turtle[data-name="leo"]').wait_for()
    pen = system.run("ros2 service call /leo/set_pen turtlesim/srv/SetPen '{r: 179, g: 184, b: 255, width: 9}'")
    assert pen.code == 0
    system.run("ros2 service call /leo/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 9.0, y: 2.0}'")
    until(lambda: drawn(page) > 2000)
    system.run("ros2 param set /turtlesim background_r 150")
    page.wait_for_function("getComputedStyle(document.getElementById('sea')).backgroundColor === 'rgb(150, 86, 255)'")
    assert page.get_by_label("Keys drive").locator("option").all_inner_texts() == ["leo", "turtle1"]
    system.run("ros2 param set /turtlesim background_r 69")
    system.run("ros2 service call /kill turtlesim/srv/Kill '{name: leo}'")
    page.locator('.turtle[data-name="leo"]').wait_for(state="detached")


@pytest.mark.exhaustive
def test_a_page_that_is_opened_late_sees_what_was_drawn_before(page: Page, browser: Browser, system: World) -> None:
    system.run("ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 1.0, y: 9.0}'")
    until(lambda: drawn(page) > 400)
    late = opened(browser, address(system))
    # The page is live before it receives what was drawn.
    until(lambda: drawn(late) == pytest.approx(drawn(page), rel=0.05))
    late.close()


# --- keys and buttons -------------------------------------------------------------------------------------------------

STANDS = "0.0,0.0,0.0,0.0,0.0,0.0"


def test_keys_drive_while_they_are_held(page: Page, system: World) -> None:
    echo = system.start("ros2 topic echo /turtle1/cmd_vel --csv")
    page.keyboard.down("ArrowUp")
    # Wait longer than one second, after which turtlesim would stop the turtle.
    echo.wait_for("2.0,0.0,0.0,0.0,0.0,0.0", times=12)
    page.keyboard.down("ArrowLeft")
    echo.wait_for("2.0,0.0,0.0,0.0,0.0,2.0")
    page.locator('.node[data-name="/view_keys"]').wait_for()
    page.keyboard.up("ArrowUp")
    echo.wait_for("0.0,0.0,0.0,0.0,0.0,2.0", times=2)
    page.keyboard.up("ArrowLeft")
    # On a busy machine, the view may have let go of the keys for a moment before, because the page sent nothing.
    until(lambda: echo.lines[-1] == STANDS)
    assert drawn(page) > 100
    echo.stop()


def test_a_tab_that_is_closed_lets_go_and_its_node_leaves(page: Page, browser: Browser, system: World) -> None:
    echo = system.start("ros2 topic echo /turtle1/cmd_vel --csv")
    other = opened(browser, address(system))
    other.keyboard.down("ArrowRight")
    echo.wait_for("0.0,0.0,0.0,0.0,0.0,-2.0", times=3)
    page.locator('.node[data-name="/view_keys"]').wait_for()
    other.close()
    echo.wait_for(STANDS)
    page.locator('.node[data-name="/view_keys"]').wait_for(state="detached")
    echo.stop()


@pytest.mark.exhaustive
def test_a_page_that_hangs_lets_go(page: Page, system: World) -> None:
    echo = system.start("ros2 topic echo /turtle1/cmd_vel --csv")
    page.keyboard.down("ArrowDown")
    echo.wait_for("-2.0,0.0,0.0,0.0,0.0,0.0", times=3)
    # The page runs no other code in the meantime.
    page.evaluate("() => { const until = performance.now() + 1500; while (performance.now() < until); }")
    echo.wait_for(STANDS)
    page.keyboard.up("ArrowDown")
    echo.stop()


def test_letters_turn_the_turtle(page: Page) -> None:
    page.keyboard.press("t")
    page.get_by_text(re.compile(r"heading 0\.7[5-9] rad")).wait_for()
    page.keyboard.press("f")
    page.get_by_label("D: to the left").click()
    page.get_by_text(re.compile(r"heading (-3|3)\.1\d rad")).wait_for()


def test_pause_stops_the_time_clear_wipes_and_reset_begins_anew(page: Page, system: World) -> None:
    poses = system.start("ros2 topic echo /turtle1/pose --csv")
    node = system.start(DRAW_CIRCLE, "Draw")
    until(lambda: drawn(page) > 200)
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("status").get_by_text("Paused").wait_for()
    stands, observed = turtle(page), len(poses.lines)
    # Send enough commands to move a turtle that is not paused.
    page.locator('[data-topic="/turtle1/pose"] .rate', has_text=re.compile("^\u2013$")).wait_for()
    assert turtle(page) == stands
    assert len(poses.lines) - observed < 20
    page.get_by_role("button", name="Clear").click()
    until(lambda: drawn(page) < FEW)
    page.get_by_role("button", name="Resume").click()
    page.get_by_role("status").get_by_text("Live").wait_for()
    until(lambda: turtle(page) != stands)
    node.stop()
    poses.stop()
    page.get_by_role("button", name="Reset").click()
    page.get_by_text("turtle1: x 5.54 m, y 5.54 m, heading 0.00 rad").wait_for()


# --- sleep and restart ------------------------------------------------------------------------------------------------

SLEEP = """state => {
    Object.defineProperty(document, "visibilityState", { value: state, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
}"""


COUNT = "() => { window.told = 0; const parse = JSON.parse; JSON.parse = text => { told++; return parse(text); } }"
"""From now on, count the messages to the page in `told`."""


@pytest.mark.exhaustive
def test_a_tab_that_slept_catches_up_at_once(page: Page, browser: Browser, system: World) -> None:
    asleep = opened(browser, address(system))
    for tab in (page, asleep):
        tab.evaluate(COUNT)
    asleep.evaluate(SLEEP, "hidden")
    until(lambda: _quiet(asleep))
    before = asleep.evaluate("told")
    node = system.start(DRAW_CIRCLE, "Draw")
    until(lambda: drawn(page) > 600)
    node.stop()
    assert asleep.evaluate("told") == before
    assert turtle(asleep) != turtle(page)
    missed = page.evaluate("told")
    asleep.evaluate(SLEEP, "visible")
    until(lambda: turtle(asleep) == turtle(page))
    until(lambda: drawn(asleep) == pytest.approx(drawn(page), rel=0.05))
    # All tabs receive new messages from now on, but not the missed ones.
    assert asleep.evaluate("told") - before < page.evaluate("told") - missed + missed / 2
    asleep.close()


def _quiet(tab: Page) -> bool:
    before = tab.evaluate("told")
    tab.wait_for_timeout(600)
    return bool(tab.evaluate("told") == before)


def test_a_simulator_that_was_started_again_is_found_by_the_same_tab(browser: Browser, fresh: World) -> None:
    first = fresh.start(VIEW, "Spawning turtle")
    tab = opened(browser, url(first))
    assert first.stop() == 0
    tab.get_by_role("status").get_by_text("Not connected").wait_for()
    second = fresh.start(VIEW, "Spawning turtle")
    tab.get_by_role("status").get_by_text("Live").wait_for()
    assert url(second) == url(first)
    moved = fresh.run("ros2 service call /turtle1/teleport_absolute turtlesim/srv/TeleportAbsolute '{x: 1.0, y: 9.0}'")
    assert moved.code == 0
    tab.get_by_text("turtle1: x 1.00 m, y 9.00 m").wait_for()
    tab.close()


# --- accessibility and errors -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(page: Page, system: World, scheme: str) -> None:
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    # A single message may be lost, since the subscription may not have discovered the new publisher yet.
    driver = system.start(
        "ros2 topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist '{linear: {x: 1.0}, angular: {z: -1.0}}'"
    )
    page.get_by_role("img", name="Angular: angular.z -1.00 rad/s").wait_for()
    driver.stop()
    assert violations(page) == []
    page.set_viewport_size({"width": 360, "height": 700})
    assert violations(page) == []
    assert cut(page) == []


def test_nothing_goes_wrong_in_the_tab_and_nothing_is_requested_of_others(browser: Browser, system: World) -> None:
    said: list[str] = []
    tab = new_page(browser)
    tab.on("pageerror", lambda error: said.append(str(error)))
    tab.on("console", lambda message: said.append(message.text))
    tab.on("requestfailed", lambda request: said.append(request.url))
    host, _, _ = live(system)
    tab.on("request", lambda request: said.append(request.url) if f"//{host}/" not in request.url else None)
    tab.goto(address(system))
    tab.locator(".graph .node").first.wait_for()
    assert said == []
    tab.close()

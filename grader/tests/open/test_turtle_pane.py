"""The live turtle in the page: turtlesim, the learner's node, the keys, and commands of ROS 2."""

from __future__ import annotations

import re
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from playwright.sync_api import TimeoutError as NotInTime
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.open.programs import NO_CELL
from grader.sandbox import bubblewrap
from grader.tests.both_worlds import HERE, REAL_ROS2
from grader.tests.browser import violations
from grader.tests.domains import own_domain
from grader.tests.narrow import cut, text_px
from grader.tests.open.course import CIRCLE, GRADER, Course, course
from grader.tests.waiting import HANG_S, until, until_gone

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pytest
    from playwright.sync_api import Browser, Page

AT_START = "turtle1: x 5.54 m, y 5.54 m, heading 0.00 rad"
AGAIN_MS = 3000
READABLE_PX = 11


def of_home(home: Path) -> list[int]:
    """Return the processes with this HOME."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            env = (place / "environ").read_bytes()
        except OSError:
            continue
        if f"HOME={home}\0".encode() in env:
            found.append(int(place.name))
    return found


def stop_real_daemon(env: Mapping[str, str]) -> None:
    """Stop the daemon that the real `ros2` starts for its next commands. This daemon would run for two hours."""
    if REAL_ROS2:
        stop = [str(HERE.prefix / "bin/ros2"), "daemon", "stop"]
        subprocess.run(stop, env=env, stdout=subprocess.DEVNULL, check=True)


def reset(page: Page) -> bool:
    """Press Reset.

    Return whether the turtle stays at its start, because the command of a last key press may still move the turtle.
    """
    page.get_by_role("button", name="Reset").click()
    with suppress(NotInTime):
        page.get_by_text(AT_START).wait_for(timeout=AGAIN_MS)
        return True
    return False


def test_the_turtle_in_the_page(browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))
    for learner in course(tmp_path):
        learner.run("start", CIRCLE)
        learner.start()
        learner.save()
        drive(learner, browser)
        stop_real_daemon(learner.env)
        started = of_home(tmp_path)
        assert started
        assert learner.end() == 0
        for pid in started:
            until_gone(pid)


def test_a_second_turtlesim_is_not_started_beside_one_in_a_terminal(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))
    for learner in course(tmp_path):
        learner.run("start", CIRCLE)
        learner.save()
        learner.start()
        with subprocess.Popen([str(GRADER), "sim"], env=learner.env, stderr=subprocess.PIPE, text=True) as terminal:
            assert terminal.stderr is not None
            while "Spawning turtle" not in terminal.stderr.readline():
                assert terminal.poll() is None
            page = learner.opened(browser, f"{CIRCLE}/index.html")
            page.get_by_role("button", name="Turtle", exact=True).click()
            page.get_by_role("button", name="Start turtlesim").click()
            page.get_by_text("Another turtlesim is already running, for example in a terminal.").wait_for()
            page.get_by_role("button", name="Run it").click()
            page.locator("#node-lines").get_by_text("[draw_circle]").wait_for()
            assert page.get_by_role("button", name="Start turtlesim").is_visible()
            page.close()
            terminal.send_signal(signal.SIGINT)
            assert terminal.wait(HANG_S) == 0
        stop_real_daemon(learner.env)


def drive(learner: Course, browser: Browser) -> None:
    page = learner.opened(browser, f"{CIRCLE}/index.html")
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.get_by_role("button", name="Turtle", exact=True).click()
    page.get_by_role("button", name="Start turtlesim").click()
    page.get_by_text(AT_START).wait_for()

    # The arrow keys drive while the canvas is focused, and scroll the lesson while it is not.
    page.locator("#sea").focus()
    page.keyboard.down("ArrowUp")
    page.locator("#where").get_by_text(re.compile(r"x (6|7|8|9|10|11)\.")).wait_for()
    page.keyboard.up("ArrowUp")
    until(lambda: reset(page))
    page.get_by_role("heading", level=1).click()
    page.keyboard.press("ArrowUp")

    page.get_by_role("button", name="Run it").click()
    page.locator("#node-lines").get_by_text("[draw_circle]").wait_for()
    where = "draw_circle is running in a sandbox." if bubblewrap.usable() else NO_CELL
    page.locator("#node-lines").get_by_text(where).wait_for()
    page.locator("#rosout").get_by_text("[INFO] [draw_circle]: ").wait_for()
    page.locator('#graph [data-name="/draw_circle"]').wait_for()
    page.locator("#where").get_by_text("x 7.").wait_for()

    page.get_by_label("ros2").fill("topic info /turtle1/cmd_vel")
    page.keyboard.press("Enter")
    page.locator("#asked").get_by_text("Type: geometry_msgs/msg/Twist").wait_for()
    page.get_by_label("ros2").fill("node info /draw_circle")
    page.keyboard.press("Enter")
    page.locator("#asked").get_by_text("/turtle1/cmd_vel: geometry_msgs/msg/Twist").wait_for()
    page.get_by_label("ros2").fill("topic pub /turtle1/cmd_vel")
    page.keyboard.press("Enter")
    page.locator("#asked").get_by_text("Only commands that change nothing").wait_for()
    page.get_by_label("ros2").fill("topics list")
    page.keyboard.press("Enter")
    page.locator("#asked").get_by_text("Did you mean `ros2 topic list`?").wait_for()
    assert violations(page) == []
    assert cut(page) == []
    assert text_px(page, "#graph") >= READABLE_PX

    learner.save("2.0", "1.0")
    page.get_by_text("This node is still running the code from before your last save.").wait_for()
    page.get_by_role("button", name="Run the new code").click()
    page.get_by_text("This node still runs").wait_for(state="hidden")
    page.get_by_role("img", name="Linear: linear.x 1.00 m/s").wait_for()

    page.get_by_role("button", name="Stop it").click()
    page.get_by_role("button", name="Run it").wait_for()
    page.get_by_label("ros2").fill("topic hz /turtle1/cmd_vel")
    page.keyboard.press("Enter")
    page.locator("#asked").get_by_text("Too few messages to measure a rate arrived within 5 s.").wait_for()
    with page.expect_response(lambda response: " hz " in (response.request.post_data or "")) as late:
        page.keyboard.press("Enter")
        page.get_by_label("ros2").fill("topics list")
        page.keyboard.press("Enter")
        page.locator("#asked").get_by_text("Did you mean `ros2 topic list`?").wait_for()
    late.value.finished()
    page.evaluate("new Promise(requestAnimationFrame)")
    assert "Did you mean" in (page.locator("#asked").text_content() or "")
    with connect(f"ws://{learner.host}/turtle?token={learner.token}", origin=Origin(f"http://{learner.host}")) as link:
        assert '"kind":"all"' in str(link.recv())
    page.get_by_role("button", name="Stop turtlesim").click()
    page.get_by_role("button", name="Start turtlesim").wait_for()
    page.get_by_text("No turtlesim of this page is running.").wait_for()
    assert "See the turtle move" not in page.content()
    # The text may be shown for less time than the browser takes to look for it, so the page collects the texts.
    page.evaluate(
        """() => {
            const status = document.getElementById("sim-status");
            globalThis.told = [];
            new MutationObserver(() => globalThis.told.push(status.textContent))
                .observe(status, { subtree: true, childList: true, characterData: true });
        }"""
    )
    page.get_by_role("button", name="Run it").click()
    until(lambda: "Starting turtlesim …" in page.evaluate("globalThis.told"))
    page.locator("#node-lines").get_by_text("[draw_circle]").wait_for()
    assert problems == []
    page.close()

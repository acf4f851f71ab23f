"""The page of the live view in a tab of a browser."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

from PIL import Image

from grader.tests.both_worlds import OUR_TURTLESIM
from grader.tests.browser import new_page

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from grader.tests.ros2.world import Running, World

VIEW = f"{OUR_TURTLESIM} --view"
PEN = (179, 184, 255)


def address(of: World) -> str:
    """Return the address that the last turtlesim has printed."""
    started = of.running[-1] if len(of.running) == 1 else next(each for each in reversed(of.running) if url(each))
    return url(started)


def url(running: Running) -> str:
    found = re.search(r"http://\S+", "\n".join(running.lines))
    return found[0] if found else ""


def opened(browser: Browser, url: str) -> Page:
    tab = new_page(browser, viewport={"width": 1000, "height": 700})
    tab.goto(url)
    tab.get_by_role("status").get_by_text("Live").wait_for()
    return tab


def drawn(page: Page) -> int:
    """Return the number of visible pixels of the canvas in the pen's colour."""
    picture = Image.open(io.BytesIO(page.locator("#sea").screenshot())).convert("RGB")
    return sum(
        count
        for count, color in picture.getcolors(maxcolors=1 << 24) or []
        if isinstance(color, tuple) and all(abs(a - b) < 12 for a, b in zip(color, PEN, strict=True))
    )


def turtle(page: Page, name: str = "turtle1") -> str:
    """Return the position of the turtle on the page."""
    return page.locator(f'.turtle[data-name="{name}"]').get_attribute("transform") or ""


def live(of: World) -> tuple[str, str, str]:
    """Return the server's host and port, the token, and the address of the connection."""
    host, _, token = address(of).removeprefix("http://").partition("/#")
    return host, token, f"ws://{host}/live?token={token}"

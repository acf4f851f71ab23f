"""Take the screenshot of the live view for README and the lessons: `python -m grader.tests.view.pictures`.

The program starts turtlesim, the solution of step 03 and the system's Chromium, and needs the same programs as the
tests.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from grader.tests.both_worlds import OUR_TURTLESIM
from grader.tests.browser import find_browser, launched, new_page
from grader.tests.ros2.world import SOLUTION, World, environment

FILE = Path(__file__).parents[3] / "course/images/view.png"
WIDTH, HEIGHT = 1240, 780


def main() -> int:
    """Write the picture. Return the exit code."""
    browser = find_browser()
    if browser is None:
        print("Chromium is not installed. Install it with: apt-get install chromium", file=sys.stderr)
        return 3
    with tempfile.TemporaryDirectory() as folder:
        # User id 0 gives this domain, so the picture is the same on every machine.
        made = World(Path(folder), environment(Path(folder), domain=1))
        try:
            take(made, browser)
        finally:
            made.end()
    print(f"Written: {FILE}")
    return 0


def take(world: World, browser: str) -> None:
    """Wait until the turtle has driven more than one circle, and then take the screenshot."""
    simulator = world.start(f"{OUR_TURTLESIM} --view", "Spawning turtle")
    url = next(word for line in simulator.lines for word in line.split() if word.startswith("http://"))
    world.start(f"python3 {SOLUTION}/my_robot_controller/draw_circle.py", "Draw")
    with launched(browser) as started:
        page = new_page(started, viewport={"width": WIDTH, "height": HEIGHT}, color_scheme="light")
        page.goto(url)
        page.locator(".arrow.flows[data-from='/draw_circle']").wait_for()
        page.locator("[data-topic='/turtle1/cmd_vel'] .rate", has_text="2 Hz").wait_for()
        # Wait for one round, and then until the turtle faces the upper left.
        page.get_by_text("heading -2.").wait_for()
        page.get_by_text("heading 2.").wait_for()
        page.screenshot(path=FILE)


if __name__ == "__main__":
    sys.exit(main())

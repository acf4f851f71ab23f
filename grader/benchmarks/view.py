"""Measure the live view with one tab and with ten: frames per second, CPU time, and the delay after a key press.

    python -m grader.benchmarks.view [--seconds 10] [--keys 30]

The simulator, the server and a browser with one page are real. Nine more pages are simulated by connections that only
listen. The browser's CPU time is not counted. Run the benchmark on an idle machine, since the browser and the simulator
share the cores.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from websockets.sync.client import connect
from websockets.typing import Origin

from grader.benchmarks.measure import cpu_s
from grader.tests.browser import browser_or_reason, launched
from grader.tests.ros2.world import SOLUTION, World, environment

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from playwright.sync_api import Browser, Page

AIM_FRAMES_HZ = 30.0
AIM_CPU = 0.15
"""The target for the share of one core that the simulator and the server use together."""
AIM_LATENCY_S = 0.06

# Returns the time from the key press until the browser draws the first frame with the moved turtle (ms).
_LATENCY = """key => new Promise(resolve => {
    const turtle = document.querySelector(".turtle");
    const before = turtle.getAttribute("transform");
    const begun = performance.now();
    function look() {
        if (turtle.getAttribute("transform") === before) requestAnimationFrame(look);
        else requestAnimationFrame(now => resolve(performance.now() - begun));
    }
    document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
    requestAnimationFrame(look);
})"""
_RELEASE = "key => document.dispatchEvent(new KeyboardEvent('keyup', { key, bubbles: true }))"
_FRAMES = """seconds => new Promise(resolve => {
    const turtle = document.querySelector(".turtle");
    let count = 0;
    const watching = new MutationObserver(() => { count += 1; });
    watching.observe(turtle, { attributes: true, attributeFilter: ["transform"] });
    const begun = performance.now();
    setTimeout(() => resolve(count / (performance.now() - begun) * 1000), seconds * 1000);
})"""


@dataclass(frozen=True)
class Cost:
    """The share of one core that the simulator and its view use."""

    simulator: float
    view: float


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="duration of each measurement")
    parser.add_argument("--keys", type=int, default=30, help="number of key presses")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        home = Path(folder)
        made = World(home, environment(home))
        stack.callback(made.end)
        plain = made.turtlesim()
        circle = f"python3 {SOLUTION}/my_robot_controller/draw_circle.py"
        node = made.start(circle, "Draw")
        without = _share([plain.process.pid], options.seconds)[0]
        node.stop()
        plain.stop()

        viewed = made.start("ros2 run turtlesim turtlesim_node --view", "Spawning turtle")
        url = next(word for line in viewed.lines for word in line.split() if word.startswith("http://"))
        browser = stack.enter_context(launched(browser_or_reason()))
        page = _opened(browser, url)
        latencies = sorted(_latency(page, number) for number in range(options.keys))
        node = made.start(circle, "Draw")
        pids = [viewed.process.pid, _child(viewed.process.pid)]
        hertz = page.evaluate(_FRAMES, options.seconds)
        one = Cost(*_share(pids, options.seconds))
        with ExitStack() as others:
            for _ in range(9):
                others.enter_context(_listening(url))
            ten = Cost(*_share(pids, options.seconds))
        page.close()
        none = Cost(*_share(pids, options.seconds))
        node.stop()
    middle_ms = 1000 * statistics.median(latencies)
    print(f"frames per second on the page: {hertz:5.1f}    (target {AIM_FRAMES_HZ:.0f})")
    print(f"key to moved turtle, median:  {middle_ms:6.0f} ms (target {1000 * AIM_LATENCY_S:.0f})")
    print(f"                     longest: {1000 * latencies[-1]:6.0f} ms")
    print(f"\n{'% of one core':24}{'simulator':>10}{'view':>8}{'both':>8}")
    print(f"{'without a view':24}{100 * without:10.1f}")
    for name, cost in (("a view, no page", none), ("one page", one), ("ten pages", ten)):
        print(f"{name:24}{100 * cost.simulator:10.1f}{100 * cost.view:8.1f}{100 * (cost.simulator + cost.view):8.1f}")
    print(f"(target: one page below {100 * AIM_CPU:.0f})")


def _opened(browser: Browser, url: str) -> Page:
    page = browser.new_page()
    page.goto(url)
    page.get_by_role("status").get_by_text("Live").wait_for()
    page.locator(".turtle").first.wait_for()
    return page


@contextmanager
def _listening(url: str) -> Iterator[None]:
    """Connect to the server like a browser tab, but without using the CPU time of a browser."""
    host, _, token = url.removeprefix("http://").partition("/#")
    with connect(f"ws://{host}/live?token={token}", origin=Origin(f"http://{host}")) as link:
        reading = threading.Thread(target=lambda: [None for _ in link], daemon=True)
        reading.start()
        yield
    reading.join()


def _latency(page: Page, number: int) -> float:
    """Return the time from a key press until the turtle moves (s). The arrow keys alternate."""
    key = "ArrowUp" if number % 2 else "ArrowDown"
    if number == 0:
        # The first key press adds the driving node to the graph.
        page.evaluate(_LATENCY, key)
        _rest(page, key)
    # Vary the time of the key press within a frame.
    time.sleep(0.2 + (number * 7 % 32) / 1000)
    latency: float = page.evaluate(_LATENCY, key)
    _rest(page, key)
    return latency / 1000


def _rest(page: Page, key: str) -> None:
    page.evaluate(_RELEASE, key)
    time.sleep(0.3)


def _share(pids: Sequence[int], seconds: float) -> list[float]:
    before = [cpu_s(pid) for pid in pids]
    begun = time.monotonic()
    time.sleep(seconds)
    lasted = time.monotonic() - begun
    return [(cpu_s(pid) - then) / lasted for pid, then in zip(pids, before, strict=True)]


def _child(pid: int) -> int:
    return int(Path(f"/proc/{pid}/task/{pid}/children").read_text().split()[0])


if __name__ == "__main__":
    main()

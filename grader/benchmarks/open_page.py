"""Measure `grader open`: the time from save to verdict relative to `grader watch`, and the page's size and idle CPU.

    python -m grader.benchmarks.open_page [--times 5] [--idle 30]

`grader open` and `grader watch` grade the same saves alternately in the same home folder. The page runs in a real
browser, whose CPU time is not counted.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect

from grader.benchmarks.measure import cpu_s
from grader.tests.browser import browser_or_reason, launched
from grader.tests.open.course import CIRCLE, GRADER, Course, course

if TYPE_CHECKING:
    from playwright.sync_api import Page

AIM_MORE_S = 0.1
"""The aim for the additional time of the page over `grader watch` (s)."""
AIM_SIZE = 600_000
AIM_READY_S = 1.0
AIM_IDLE = 0.01
"""The aim for the share of one core that an idle page uses."""
_REST_S = 2.0
"""The shortest time that a learner needs between two saves (s), during which the next trial is prepared."""
_PATIENCE_S = 300
_SAVES = (("2.0", "3.0", "50 of 100 points"), ("2.0", "2.0", "100 of 100 points"))

_OBSERVE = """(line) => {
    globalThis.shown = new Promise((resolve) => {
        const look = () => document.getElementById("verdict-line").textContent.includes(line) && resolve(true);
        new MutationObserver(look).observe(document.body, { subtree: true, childList: true, characterData: true });
        look();
    });
    return null;
}"""
"""Wait without polling, which would keep the browser busy while the grader works."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of saves, whose median time is printed")
    parser.add_argument("--idle", type=float, default=30.0, help="duration of the idle measurement in seconds")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, launched(browser_or_reason()) as browser:
        for learner in course(Path(folder)):
            learner.run("start", CIRCLE)
            learner.start()
            page = learner.opened(browser)
            page.locator("#verdict-line").get_by_text("15 of 100").wait_for()
            in_page = [_in_page_s(learner, page, number) for number in range(arguments.times)]
            size, ready_s = _loaded(page)
            idle = _idle(arguments.idle)
            page.close()
            learner.end()
            in_watch = _in_watch_s(learner, arguments.times)
    more_s = statistics.median(in_page) - statistics.median(in_watch)
    print(f"save to verdict: page {statistics.median(in_page):.2f} s, watch {statistics.median(in_watch):.2f} s,")
    print(f"  {more_s:+.2f} s (aim {AIM_MORE_S:+.2f} s)")
    print(f"the page of {CIRCLE}: {size / 1000:.0f} kB (aim {AIM_SIZE / 1000:.0f} kB)")
    print(f"ready after {ready_s:.2f} s (aim {AIM_READY_S:.2f} s)")
    print(f"idle: {idle:.2%} of a core (aim {AIM_IDLE:.0%})")


def _in_page_s(learner: Course, page: Page, number: int) -> float:
    """Return the time from a save until the page shows the verdict (s)."""
    old, new, line = _SAVES[number % len(_SAVES)]
    time.sleep(_REST_S)
    page.evaluate(_OBSERVE, line)
    begun = time.monotonic()
    learner.save(old, new)
    page.evaluate("globalThis.shown")
    return time.monotonic() - begun


def _in_watch_s(learner: Course, times: int) -> list[float]:
    """Return the time from each save until `grader watch` has printed the verdict (s)."""
    screen = pexpect.spawn(
        str(GRADER), ["watch"], env=learner.env, encoding="utf-8", timeout=_PATIENCE_S, dimensions=(60, 110)
    )
    screen.delaybeforesend = None
    screen.expect("Watching")
    found = []
    # The first save differs from the last one in the page.
    for number in range(times, 2 * times):
        old, new, line = _SAVES[number % len(_SAVES)]
        time.sleep(_REST_S)
        begun = time.monotonic()
        learner.save(old, new)
        # A proof prints the report again, so the line must be that of this save.
        screen.expect(line)
        found.append(time.monotonic() - begun)
    screen.send("q")
    screen.expect(pexpect.EOF)
    screen.close()
    return found


def _loaded(page: Page) -> tuple[int, float]:
    """Load the page without a cache. Return the total size of its files (bytes), and the time until it is ready (s)."""
    sizes: list[int] = []
    page.on("response", lambda response: sizes.append(len(response.body())) if response.ok else None)
    begun = time.monotonic()
    page.reload()
    page.get_by_text("Live", exact=True).wait_for()
    ready_s = time.monotonic() - begun
    page.wait_for_load_state("networkidle")
    return sum(sizes), ready_s


def _idle(seconds: float) -> float:
    """Return the share of one core that the descendants of this process use, without the browser."""
    time.sleep(_REST_S)
    before = _used_s()
    time.sleep(seconds)
    after = _used_s()
    return sum(after[pid] - before[pid] for pid in after.keys() & before.keys()) / seconds


def _used_s() -> dict[int, float]:
    """Return the CPU time (s) of the descendants of this process, without the browser."""
    used = {}
    for pid in _descendants(os.getpid()):
        with suppress(OSError):  # the process has exited
            if "chrom" not in _name(pid) and "node" not in _name(pid):
                used[pid] = cpu_s(pid)
    return used


def _descendants(pid: int) -> list[int]:
    found: list[int] = []
    with suppress(OSError):
        for task in Path(f"/proc/{pid}/task").iterdir():
            for child in map(int, (task / "children").read_text().split()):
                found += [child, *_descendants(child)]
    return found


def _name(pid: int) -> str:
    return Path(f"/proc/{pid}/comm").read_text().strip()


if __name__ == "__main__":
    main()

"""Measure `grader open`: the time from save to verdict relative to `grader watch`, the page's size and idle CPU time.

    python -m grader.benchmarks.open_page [--times 5] [--idle 30]

`grader open` and `grader watch` grade the same changes in turn. The benchmark waits until everything is idle before
each save. The page runs in a real browser, whose CPU time is not counted.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect

from grader.benchmarks.measure import cpu_s
from grader.tests.browser import browser_or_reason, launched
from grader.tests.open.course import CIRCLE, GRADER, course

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Page, Response

    from grader.tests.open.course import Course

AIM_MORE_S = 0.1
"""The target for the time that the page needs in addition to the time of `grader watch` (s)."""
AIM_SIZE = 600_000
AIM_READY_S = 1.0
AIM_IDLE = 0.01
"""The target for the share of one core that an idle page uses."""
_DRIVER = ("node", "node-MainThread")
"""The possible process names of Playwright's driver. The name depends on the version of Node.js."""
_REST_S = 2.0
_IDLE_S = 0.1
"""The processes are idle if they use at most this CPU time (s) within _REST_S."""
_PATIENCE_S = 300
_SAVES = (("2.0", "3.0", "50 of 100 points"), ("2.0", "2.0", "100 of 100 points"))

_OBSERVE = """(line) => {
    globalThis.shown = new Promise((resolve) => {
        const look = () => document.getElementById("verdict-line").textContent.includes(line) &&
            requestAnimationFrame(() => resolve(Date.now() / 1000));
        new MutationObserver(look).observe(document.body, { subtree: true, childList: true, characterData: true });
        look();
    });
    return null;
}"""
"""This script does not poll, because polling would keep the browser busy while the grader works. The value of `shown`
is the time at which the browser drew the verdict, so the time that a message takes from the browser to this process is
not included."""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of pairs of saves, whose median time is printed")
    parser.add_argument("--idle", type=float, default=30.0, help="duration of the idle measurement in seconds")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, launched(browser_or_reason()) as browser, ExitStack() as stack:
        paged, watched = (_begun(stack, Path(folder) / name) for name in ("page", "watch"))
        paged.start()
        page = paged.opened(browser)
        page.locator("#verdict-line").get_by_text("15 of 100").wait_for()
        size, ready_s = _loaded(page)
        _rest()
        idle = _idle(arguments.idle)
        screen = stack.enter_context(_screen(watched))
        pairs = [_pair(paged, page, watched, screen, _SAVES[at % 2]) for at in range(arguments.times)]
    in_page, in_watch = (statistics.median(times) for times in zip(*pairs, strict=True))
    more_s = statistics.median(page_s - watch_s for page_s, watch_s in pairs)
    print(f"save to verdict: page {in_page:.2f} s, watch {in_watch:.2f} s,")
    print(f"  {more_s:+.2f} s (target {AIM_MORE_S:+.2f} s), from {_differences(pairs)}")
    print(f"the page of {CIRCLE}: {size / 1000:.0f} kB (target {AIM_SIZE / 1000:.0f} kB)")
    print(f"ready after {ready_s:.2f} s (target {AIM_READY_S:.2f} s)")
    print(f"idle: {idle:.2%} of a core (target {AIM_IDLE:.0%})")


def _begun(stack: ExitStack, home: Path) -> Course:
    """Start the step with `grader start` in a new home folder, and return the Course object of this folder."""
    home.mkdir()
    learner = stack.enter_context(contextmanager(course)(home))
    learner.run("start", CIRCLE)
    return learner


def _differences(pairs: list[tuple[float, float]]) -> str:
    return ", ".join(f"{page_s - watch_s:+.2f}" for page_s, watch_s in pairs)


def _pair(
    paged: Course, page: Page, watched: Course, screen: pexpect.spawn[str], save: tuple[str, str, str]
) -> tuple[float, float]:
    """Save the same change for the page and for `grader watch`. Return the time until each shows the verdict (s)."""
    old, new, line = save
    _rest()
    page.evaluate(_OBSERVE, line)
    begun = time.time()
    paged.save(old, new)
    page_s = page.evaluate("globalThis.shown") - begun
    _rest()
    begun = time.time()
    watched.save(old, new)
    # `grader watch` prints the report again when a cause is confirmed, so the line must belong to this save.
    screen.expect(line)
    return page_s, time.time() - begun


@contextmanager
def _screen(learner: Course) -> Iterator[pexpect.spawn[str]]:
    """Start `grader watch` in a terminal, and wait for its first verdict."""
    screen = pexpect.spawn(
        str(GRADER), ["watch"], env=learner.env, encoding="utf-8", timeout=_PATIENCE_S, dimensions=(60, 110)
    )
    screen.delaybeforesend = None
    screen.expect("Watching")
    yield screen
    screen.send("q")
    screen.expect(pexpect.EOF)
    screen.close()


def _rest() -> None:
    """Wait until all descendants of this process are idle: no trial is being prepared or run.

    The pause is realistic, because a learner also needs some seconds between two saves.
    """
    used_s = [0.0, sum(_used_s().values())]
    while used_s[-1] - used_s[-2] > _IDLE_S:
        time.sleep(_REST_S)
        used_s.append(sum(_used_s().values()))


def _loaded(page: Page) -> tuple[int, float]:
    """Load the page without a cache.

    Return the total size of the page's files (bytes), and the time until the page is ready (s).
    """
    sizes: list[int] = []

    def weigh(response: Response) -> None:
        if response.ok:
            sizes.append(len(response.body()))

    page.on("response", weigh)
    begun = time.monotonic()
    page.reload()
    page.get_by_text("Live", exact=True).wait_for()
    ready_s = time.monotonic() - begun
    page.wait_for_load_state("networkidle")
    page.remove_listener("response", weigh)
    return sum(sizes), ready_s


def _idle(seconds: float) -> float:
    """Return the share of one core that the descendants of this process use, excluding the browser."""
    before = _used_s()
    time.sleep(seconds)
    after = _used_s()
    return sum(after[pid] - before[pid] for pid in after.keys() & before.keys()) / seconds


def _used_s() -> dict[int, float]:
    """Return the CPU time (s) by process id of the descendants of this process, without the browser and its driver."""
    used = {}
    for pid in _descendants(os.getpid()):
        with suppress(OSError):  # the process has exited
            if "chrom" not in (name := _name(pid)) and name not in _DRIVER:
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

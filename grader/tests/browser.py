"""Find the system's Chromium or Chrome for the tests of the pages."""

from __future__ import annotations

import os
import shutil
from contextlib import contextmanager
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import pytest

from grader.setup.machine import BROWSERS, SYSTEM_PATH
from grader.tests.lacking import give_up
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

FLAGS = (
    # Chromium has no sandbox when root starts it. It opens only our own files.
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


def find_browser() -> str | None:
    """Return the path of Chromium or Chrome, or None."""
    search = os.pathsep.join([os.environ.get("PATH", ""), *SYSTEM_PATH])
    return next(filter(None, (shutil.which(name, path=search) for name in BROWSERS)), None)


def browser_or_reason() -> str:
    """Return the path of Chromium. Without Chromium, the test is skipped and the reason is shown.

    In CI, the test fails if Chromium is missing, unless TESTS_WITHOUT_BROWSER is set.
    """
    found = find_browser()
    if found is None:
        if os.environ.get("TESTS_WITHOUT_BROWSER"):
            pytest.skip("TESTS_WITHOUT_BROWSER is set, and Chromium is not installed")
        give_up("Chromium", "chromium")
    return found


@contextmanager
def launched(executable: str) -> Iterator[Browser]:
    """Start Chromium without a window."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(FLAGS), timeout=HANG_S * 1000)
        yield browser
        browser.close()


def new_page(browser: Browser, **options: Any) -> Page:  # noqa: ANN401 - the options of Browser.new_page
    """Open a page without cookies or storage of other pages.

    Playwright waits for 30 s for each event of a page, which is too short on a busy machine. Here, it waits for HANG_S.
    """
    page = browser.new_page(**options)
    page.set_default_timeout(HANG_S * 1000)
    return page


def violations(page: Page) -> list[str]:
    """Return the violations that axe-core finds on the page in its current state, as text."""
    page.evaluate((files("axe_playwright_python") / "axe.min.js").read_text("utf-8"))
    found: list[str] = page.evaluate(
        "() => axe.run().then(all => all.violations.map(each => "
        "each.id + ': ' + each.help + ' ' + each.nodes.map(node => node.html).join(' ')))"
    )
    return found

"""The programs that the tests of the page use, and a browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.browser import browser_or_reason, launched
from grader.tests.ros2.world import World, world
from grader.tests.view.tab import VIEW, address, opened

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

SHOWN = "all => all.map(each => Object.values(each.dataset).join(' -> '))"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(browser_or_reason()) as browser:
        yield browser


@pytest.fixture(scope="module")
def system(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a world with only turtlesim and its view."""
    for made in world(tmp_path_factory.mktemp("view")):
        made.start(VIEW, "Spawning turtle")
        yield made


@pytest.fixture
def fresh(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create an empty world."""
    yield from world(tmp_path_factory.mktemp("fresh"))


@pytest.fixture
def page(browser: Browser, system: World) -> Iterator[Page]:
    """Open the page with a clean canvas."""
    tab = opened(browser, address(system))
    tab.get_by_role("button", name="Reset").click()
    tab.get_by_text("turtle1: x 5.54 m, y 5.54 m, heading 0.00 rad").wait_for()
    yield tab
    # pytest shows this if the test has failed.
    print("The programs wrote:", *(line for each in system.running for line in each.lines), sep="\n")
    print("The graph of the page:", tab.locator(".node, .arrow").evaluate_all(SHOWN), sep="\n")
    tab.close()

"""A running `grader open` with step 03 started, and a browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.browser import browser_or_reason, launched
from grader.tests.open.course import CIRCLE, Course, course

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(browser_or_reason()) as browser:
        yield browser


@pytest.fixture(scope="module")
def learner(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Course]:
    """Create a learner who has not started a step yet, with a server."""
    for made in course(tmp_path_factory.mktemp("learner")):
        made.start()
        yield made


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Course]:
    """Create a learner who has started step 03, with a server."""
    for made in course(tmp_path_factory.mktemp("begun")):
        made.run("start", CIRCLE)
        made.start()
        yield made

"""The page survives reloading, a second tab, a renamed folder, and a server that is killed and started again."""

from __future__ import annotations

import os
import signal
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.open.course_page import elsewhere
from grader.tests.open.course import CIRCLE, Course, course
from grader.tests.waiting import until, until_gone

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page


@pytest.fixture
def own(tmp_path: Path) -> Iterator[Course]:
    """Create a learner for one test, with step 03 started."""
    for made in course(tmp_path):
        made.run("start", CIRCLE)
        made.start()
        yield made


def verdict(page: Page, text: str) -> None:
    page.locator("#verdict-line").get_by_text(text).wait_for()


def children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@contextmanager
def asleep(pid: int) -> Iterator[None]:
    """Suspend a process and all its descendants for a while, as happens when a laptop sleeps.

    A descendant may end before it is suspended, or be killed by a process that has already been resumed.
    """
    stopped = [pid]
    for each in stopped:
        with suppress(ProcessLookupError, FileNotFoundError):
            os.kill(each, signal.SIGSTOP)
            stopped += children(each)
    yield
    for each in stopped:
        with suppress(ProcessLookupError):
            os.kill(each, signal.SIGCONT)


def test_the_page_survives_what_people_do(own: Course, browser: Browser) -> None:
    page = own.opened(browser)
    verdict(page, "15 of 100")
    assert own.token not in page.url

    page.reload()
    verdict(page, "15 of 100")

    # A second tab of the same browser gets the token from the first one.
    with page.context.expect_page() as second:
        page.evaluate(f"window.open('/{CIRCLE}/index.html', '_blank', 'noopener')")
    verdict(second.value, "15 of 100")

    # `start --fresh` renames the folder, and a new one takes its place.
    own.save()
    verdict(page, "Passed: 100")
    own.run("start", CIRCLE, "--fresh")
    verdict(page, "15 of 100")
    verdict(second.value, "15 of 100")
    own.save("2.0", "3.0")
    verdict(page, "50 of 100 points")
    second.value.close()

    # The machine sleeps, and finds another file when it wakes up.
    with asleep(own.processes[-1].pid):
        own.save()
    verdict(page, "Passed: 100")
    own.save("2.0", "3.0")
    verdict(page, "50 of 100 points")

    # The server is killed and started again. The address and the token stay the same, and the open page continues.
    before = own.url
    assert own.end(signal.SIGKILL) == -signal.SIGKILL
    page.get_by_text("Not connected: type grader open").wait_for()
    assert own.start() == before
    page.get_by_text("Live", exact=True).wait_for()
    own.save()
    verdict(page, "Passed: 100")

    # Start another step in a terminal.
    own.run("start", "04")
    page.get_by_text("Verdict on step 04").wait_for()

    pid = own.processes[-1].pid
    waiting = children(pid)
    assert own.end() == 0
    for child in waiting:
        until_gone(child)
    page.close()


def test_ctrl_c_during_a_grading_leaves_nothing(own: Course) -> None:
    pid = own.processes[-1].pid
    until(lambda: bool(children(pid)))
    started = children(pid)
    assert own.end() == 0
    for child in started:
        until_gone(child)


def test_the_command_for_another_machine_is_one_line() -> None:
    assert elsewhere(4711, {}) == []
    (line,) = elsewhere(4711, {"SSH_CONNECTION": "10.0.0.2 50000 10.0.0.9 22"})
    assert "ssh -N -L 4711:127.0.0.1:4711 " in line
    assert line.endswith("@10.0.0.9")
    (line,) = elsewhere(4711, {"CODESPACES": "true", "CODESPACE_NAME": "fluffy-robot"})
    assert line.endswith("gh codespace ports forward 4711:4711 --codespace fluffy-robot")

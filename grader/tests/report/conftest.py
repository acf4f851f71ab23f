"""Pages of reports, and a browser tab whose errors are collected."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.report.html import save_html
from grader.report.html_class import save_class_page
from grader.report.json import to_json
from grader.tests.browser import browser_or_reason, launched, new_page
from grader.tests.report.pages import GIVEN
from grader.tests.report.reports import report, report_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Dialog, Page


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(browser_or_reason()) as browser:
        yield browser


@pytest.fixture(scope="session")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the page of each submission in GIVEN, and with class.html."""
    folder = tmp_path_factory.mktemp("pages")
    for name, given in GIVEN.items():
        save_html(given, report_of(given, submission=given.submission.name), folder / f"{name}.html")
    reports = folder / "class"
    reports.mkdir()
    for number in range(12):
        status = ("passed", "failed", "skipped", "error")[number % 4]
        made = report(status, submission=f"submitted/student{number}")
        (reports / f"student{number}.json").write_text(to_json(made), "utf-8")
        (reports / f"student{number}.html").write_text("a page")
    save_class_page(reports, folder / "class.html")
    return folder


@pytest.fixture
def problems() -> list[str]:
    """Return the problems in the tab: errors, console messages, dialogs, and requested URLs that are not files."""
    return []


@pytest.fixture
def page(browser: Browser, problems: list[str]) -> Iterator[Page]:
    """Yield a new tab of the browser."""

    def note_dialog(dialog: Dialog) -> None:
        problems.append(dialog.message)
        dialog.dismiss()

    tab = new_page(browser, viewport={"width": 1280, "height": 900})
    tab.on("pageerror", lambda error: problems.append(str(error)))
    tab.on("console", lambda message: problems.append(message.text))
    tab.on("dialog", note_dialog)
    tab.on("request", lambda request: problems.append(request.url) if not request.url.startswith("file:") else None)
    yield tab
    tab.close()

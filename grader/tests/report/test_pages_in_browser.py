"""The pages in a browser: folding, width, keyboard, colours, printing, and accessibility with axe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import pytest

from grader.tests.browser import new_page, violations
from grader.tests.narrow import cut
from grader.tests.report.pages import GIVEN, opened, unfold

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Page


def test_the_page_is_complete_without_javascript(browser: Browser, pages: Path) -> None:
    tab = new_page(browser, java_script_enabled=False)
    tab.goto((pages / "failed.html").as_uri())
    assert not tab.locator(".player").is_visible()
    assert tab.locator("svg.canvas").is_visible()
    assert tab.get_by_text("The radius of the circle is 2.2 m.").is_visible()
    tab.close()


def test_the_keyboard_opens_and_closes_logs(page: Page, pages: Path) -> None:
    opened(page, pages, "skipped")
    log = page.locator("details#log-build")
    text = log.locator("pre").last
    assert not text.is_visible()
    log.locator("summary").focus()
    page.keyboard.press("Enter")
    assert text.is_visible()
    assert "no such option" in text.inner_text()
    page.keyboard.press("Enter")
    assert not text.is_visible()


def test_the_first_tab_stop_skips_the_links(page: Page, pages: Path) -> None:
    opened(page, pages, "failed")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.keyboard.press("Enter")
    page.wait_for_url(lambda url: url.endswith("#main"))


@pytest.mark.parametrize("name", [*GIVEN, "class"])
def test_nothing_is_wider_than_the_page(page: Page, pages: Path, name: str, problems: list[str]) -> None:
    opened(page, pages, name)
    unfold(page)
    assert cut(page) == []
    page.set_viewport_size({"width": 1600, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 1600
    assert problems == []


@pytest.mark.parametrize("name", [*GIVEN, "class"])
@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 360), ("dark", 1600)])
@pytest.mark.exhaustive
def test_axe_finds_nothing_on_any_page(page: Page, pages: Path, name: str, scheme: str, width: int) -> None:
    assert violations_on(page, pages, name, scheme, width) == []


@pytest.mark.parametrize(
    ("name", "scheme", "width"),
    [("failed", "light", 1280), ("failed", "dark", 360), ("class", "light", 360), ("class", "dark", 1280)],
)
def test_axe_finds_nothing(page: Page, pages: Path, name: str, scheme: str, width: int) -> None:
    assert violations_on(page, pages, name, scheme, width) == []


def violations_on(page: Page, pages: Path, name: str, scheme: str, width: int) -> list[str]:
    """Return the violations that axe finds on a page with all sections open."""
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.set_viewport_size({"width": width, "height": 900})
    opened(page, pages, name)
    unfold(page)
    return violations(page)


def test_axe_finds_a_button_without_a_name(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    page.evaluate("document.querySelector('.play').textContent = ''")
    assert violations(page) != []


def test_the_page_has_light_and_dark_colours(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    observed = []
    schemes: tuple[Literal["light", "dark"], ...] = ("light", "dark")
    for scheme in schemes:
        page.emulate_media(color_scheme=scheme)
        observed.append(page.evaluate("getComputedStyle(document.body).backgroundColor"))
    assert observed == ["rgb(255, 255, 255)", "rgb(20, 24, 29)"]


def test_a_printed_page_has_open_details_and_no_player(page: Page, pages: Path) -> None:
    opened(page, pages, "failed")
    page.emulate_media(color_scheme="dark")
    page.evaluate(
        "addEventListener('beforeprint', () => { window.open_ = document.querySelectorAll('details[open]').length; })"
    )
    paper = page.pdf(format="A4")
    assert paper.startswith(b"%PDF")
    assert page.evaluate("window.open_") == 2
    page.emulate_media(media="print")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert not page.locator(".player").is_visible()
    assert page.locator("details[open]").count() == 0


def test_a_printed_class_page_names_every_failed_check(page: Page, pages: Path) -> None:
    opened(page, pages, "class")
    page.emulate_media(media="print")
    failed = page.locator(".failure > summary")
    assert failed.count() > 1
    assert all(each.is_visible() for each in failed.all())

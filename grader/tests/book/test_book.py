"""`grader book`: the lessons as pages for a web server."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import pytest
from typer.testing import CliRunner

from grader.book.lesson import LESSON, lessons
from grader.book.site import write_book
from grader.checks.exercises import find_exercise
from grader.cli import app
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.tests.book.served import served
from grader.tests.browser import browser_or_reason, launched, new_page, violations
from grader.tests.case import ROOT
from grader.tests.narrow import cut

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Page

CIRCLE = "03-circle-publisher/index.html"
_LINK = re.compile(r"(?:\[Step \d+: |\d+\. \[)([^\]]+)\]\([./]*(?:course/)?([^/)]+)/lesson\.md\)")
"""A link to a lesson with its title: at the end of another lesson, and in the list of docs/learner.md."""


@pytest.fixture(scope="module")
def book(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("book")
    write_book(out, "https://git.example/course")
    return out


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(browser_or_reason()) as browser:
        yield browser


@pytest.fixture(scope="module")
def url(book: Path) -> Iterator[str]:
    with served(book) as url:
        yield url


@pytest.fixture
def requests() -> list[str]:
    """Collect the URLs that the tab requests and the errors that it reports."""
    return []


@pytest.fixture
def page(browser: Browser, requests: list[str]) -> Iterator[Page]:
    tab = new_page(browser, viewport={"width": 1280, "height": 900})
    tab.on("request", lambda request: requests.append(request.url))
    tab.on("console", lambda message: requests.append(message.text))
    tab.on("pageerror", lambda error: requests.append(str(error)))
    yield tab
    tab.close()


def test_a_lesson_has_the_title_of_its_exercise_and_so_have_the_links_to_it() -> None:
    titles = {lesson.id: lesson.title for lesson in lessons()}
    assert titles == {name: find_exercise(name).title for name in catalogue()}
    texts = [(lesson.folder / LESSON).read_text("utf-8") for lesson in lessons()]
    texts.append((ROOT / "docs/learner.md").read_text("utf-8"))
    links = [link for text in texts for link in _LINK.findall(text)]
    assert len(links) > 3 * (len(titles) - 1)
    assert {(name, title[0].upper() + title[1:]) for title, name in links} <= set(titles.items())


def test_every_step_has_a_page(book: Path) -> None:
    contents = (book / "index.html").read_text("utf-8")
    for name in catalogue():
        assert (book / name / "index.html").is_file()
        assert f'href="{name}/index.html"' in contents


def test_all_links_inside_the_book_lead_somewhere(book: Path) -> None:
    for page in book.rglob("*.html"):
        text = page.read_text("utf-8")
        anchors = set(re.findall(r'id="([^"]+)"', text))
        for link in re.findall(r'(?:href|src)="([^"]+)"', text):
            place, _, anchor = link.partition("#")
            if "://" not in link:
                target = (page.parent / place).resolve() if place else page
                assert target.is_file(), f"{page}: {link}"
                assert not anchor or place or anchor in anchors, f"{page}: {link}"


def test_pages_contain_no_path_of_this_machine(book: Path) -> None:
    for page in book.rglob("*.html"):
        assert str(lessons()[0].folder.parent.parent) not in page.read_text("utf-8")


def test_out_is_a_file(tmp_path: Path) -> None:
    file = tmp_path / "out"
    file.touch()
    with pytest.raises(UsageError, match="is a file"):
        write_book(file)


def test_the_repository_must_be_a_url(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["book", str(tmp_path), "--repository", "javascript:alert(1)"])
    assert isinstance(done.exception, UsageError)


def test_the_page_loads_nothing_from_elsewhere(page: Page, url: str, requests: list[str]) -> None:
    page.goto(url + CIRCLE)
    page.get_by_role("link", name="The repository of this course").wait_for()
    page.get_by_label("Search").fill("radius")
    page.locator("#search-found li").first.wait_for()
    assert [each for each in requests if not each.startswith(url)] == []


def test_the_search_leads_to_a_section(page: Page, url: str) -> None:
    page.goto(url + "index.html")
    page.get_by_label("Search").press_sequentially("queue size create_publisher")
    page.get_by_role("link", name="The parts you need").click()
    page.wait_for_url(f"{url}{CIRCLE}#the-parts-you-need")
    page.get_by_label("Search").fill("quokka zyzzyva")
    page.get_by_text("No section contains all of these words.").wait_for()
    page.get_by_label("Search").fill("quokka")
    page.get_by_text("No section contains this word.").wait_for()
    page.keyboard.press("Escape")
    assert page.get_by_label("Search").input_value() == ""


def test_the_search_by_keyboard(page: Page, book: Path, url: str) -> None:
    page.goto(url + "index.html")
    search = page.get_by_label("Search")
    search.press_sequentially("queue size create_publisher")
    results = page.locator("#search-found")
    results.get_by_role("link").first.wait_for()
    # An excerpt begins and ends with whole words.
    excerpt = results.locator(".excerpt").first.inner_text().strip("… ")
    texts = [f" {' '.join(entry['text'].split())} " for entry in json.loads((book / "search.json").read_text("utf-8"))]
    assert any(f" {' '.join(excerpt.split())} " in text for text in texts), excerpt
    for key in ("ArrowDown", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    page.wait_for_url(f"{url}{CIRCLE}#the-parts-you-need")


def test_the_copy_button_copies_only_the_command(browser: Browser, url: str) -> None:
    tab = new_page(browser, permissions=["clipboard-read", "clipboard-write"])
    tab.goto(url + CIRCLE)
    tab.get_by_role("button", name="Copy the command").first.click()
    tab.get_by_text("Copied").wait_for()
    assert tab.evaluate("navigator.clipboard.readText()") == "ros2 topic info /turtle1/cmd_vel"
    tab.close()


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 360)])
def test_axe_finds_nothing_and_nothing_is_cut(page: Page, url: str, scheme: str, width: int) -> None:
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.set_viewport_size({"width": width, "height": 800})
    for name in ("index.html", CIRCLE, "07-challenges/index.html"):
        page.goto(url + name)
        page.locator(".search").wait_for()
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_no_page_is_cut_on_a_phone(page: Page, url: str) -> None:
    for name in ("index.html", *(f"{step}/index.html" for step in catalogue())):
        page.goto(url + name)
        page.locator(".search").wait_for()
        assert cut(page) == [], name


def test_a_printed_lesson_is_only_the_lesson(page: Page, url: str) -> None:
    page.goto(url + CIRCLE)
    page.emulate_media(media="print")
    assert not page.get_by_label("Steps", exact=True).is_visible()
    assert not page.locator(".copy").first.is_visible()
    assert page.get_by_role("heading", level=1).is_visible()

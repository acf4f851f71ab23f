"""The pages in a browser: played, sorted, folded, printed, looked at by axe; and what a hostile one does not do."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import pytest

from grader.checks.outcome import Finding, Status
from grader.report.html import save_html
from grader.report.html_class import save_class_page
from grader.report.json import to_json
from grader.tests.browser import browser_or_reason, launched, violations
from grader.tests.checks.made import evidence, node
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.hostile import enormous, hostile
from grader.tests.report.reports import EVIDENCE, report, report_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Dialog, Page

    from grader.evidence.evidence import Evidence

GIVEN: dict[str, Evidence] = {
    **EVIDENCE,
    "failed": evidence(SHAPES["radius 2.2"](), node(("linear.x = 2.0", "linear.x = 2.2"))),
    "nan": evidence(SHAPES["nan"]()),
    "no messages": evidence(SHAPES["no messages"]()),
    "wall": evidence(SHAPES["wall"]()),
    "hostile": hostile(),
    "enormous": enormous(),
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(browser_or_reason()) as browser:
        yield browser


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page of each of GIVEN, and class.html."""
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
def said() -> list[str]:
    """What went wrong in the tab: errors, messages of its console, dialogs, addresses asked for."""
    return []


@pytest.fixture
def page(browser: Browser, said: list[str]) -> Iterator[Page]:
    def note_dialog(dialog: Dialog) -> None:
        said.append(dialog.message)
        dialog.dismiss()

    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.on("pageerror", lambda error: said.append(str(error)))
    tab.on("console", lambda message: said.append(message.text))
    tab.on("dialog", note_dialog)
    tab.on("request", lambda request: said.append(request.url) if not request.url.startswith("file:") else None)
    yield tab
    tab.close()


def opened(page: Page, pages: Path, name: str) -> Page:
    page.goto((pages / f"{name}.html").as_uri())
    return page


def stand_still(page: Page) -> None:
    """Stop the page's time: from here it moves only by `page.clock.run_for`."""
    page.clock.install(time=0)
    page.clock.pause_at(1)


def turtle(page: Page) -> tuple[float, float, float]:
    """Where the turtle is drawn: x, y, and by how much it is turned (degrees)."""
    transform = page.locator(".turtle").get_attribute("transform") or ""
    x, y, degrees = map(float, re.findall(r"-?[\d.]+", transform))
    return x, y, degrees


def test_the_replay_moves_the_turtle_at_the_chosen_speed_and_ends(page: Page, pages: Path, said: list[str]) -> None:
    stand_still(page)
    opened(page, pages, "passed")
    rest = turtle(page)
    page.get_by_label("Speed").select_option("2")
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(1000)
    assert float(page.locator(".slider").input_value()) == pytest.approx(2.0, abs=0.3)
    x, y, degrees = turtle(page)
    # After 2 s of which 0.5 s passed before the first command: 1.5 rad round the centre (5.54, 7.54) m, to the left.
    assert degrees == pytest.approx(-86, abs=17)
    assert (x, y) != rest[:2]
    button = page.get_by_role("button", name="Pause")
    button.click()
    paused = page.locator(".slider").input_value()
    page.clock.run_for(1000)
    assert page.locator(".slider").input_value() == paused
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(5000)
    assert page.get_by_role("button", name="Play").is_visible()
    assert turtle(page) == rest
    assert said == []


def test_twenty_times_is_twenty_times(page: Page, pages: Path) -> None:
    stand_still(page)
    opened(page, pages, "passed")
    page.get_by_label("Speed").select_option("20")
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(250)
    assert float(page.locator(".slider").input_value()) == pytest.approx(5.0, abs=0.7)


def test_the_slider_is_moved_by_keys_and_says_the_time(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    slider = page.get_by_role("slider", name="Time")
    slider.focus()
    page.keyboard.press("Home")
    start = turtle(page)
    assert start[2] == 0
    assert "no command yet" in page.locator(".now").inner_text()
    for _ in range(20):
        page.keyboard.press("ArrowRight")
    assert slider.get_attribute("aria-valuetext") == "2.0 of 10.0 seconds"
    assert turtle(page) != start
    assert "linear.x 2.00 m/s" in page.locator(".now").inner_text()
    heads = page.locator(".head")
    assert heads.count() == 3
    assert {heads.nth(index).get_attribute("visibility") for index in range(3)} == {"visible"}


def test_the_way_gone_follows_the_turtle(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    page.get_by_role("slider", name="Time").fill("4")
    points = page.locator(".gone").get_attribute("points") or ""
    last = points.split()[-1].split(",")
    assert [float(each) for each in last] == pytest.approx(turtle(page)[:2], abs=0.2)


def test_a_turtle_that_is_nowhere_is_not_drawn(page: Page, pages: Path) -> None:
    opened(page, pages, "nan")
    page.get_by_role("slider", name="Time").fill("9")
    assert page.locator(".turtle").get_attribute("visibility") == "hidden"
    assert "not a number" in page.locator(".now").inner_text()
    page.get_by_role("slider", name="Time").fill("0.1")
    assert page.locator(".turtle").get_attribute("visibility") == "visible"


def test_without_scripts_the_page_is_whole(browser: Browser, pages: Path) -> None:
    tab = browser.new_page(java_script_enabled=False)
    tab.goto((pages / "failed.html").as_uri())
    assert not tab.locator(".player").is_visible()
    assert tab.locator("svg.canvas").is_visible()
    assert tab.get_by_text("The radius of the circle is 2.2 m.").is_visible()
    tab.close()


def test_logs_unfold_and_fold_by_keyboard(page: Page, pages: Path) -> None:
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


def test_the_first_key_leads_past_the_links(page: Page, pages: Path) -> None:
    opened(page, pages, "failed")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.keyboard.press("Enter")
    page.wait_for_url(lambda url: url.endswith("#main"))


@pytest.mark.parametrize("name", [*GIVEN, "class"])
def test_nothing_is_wider_than_the_page(page: Page, pages: Path, name: str, said: list[str]) -> None:
    opened(page, pages, name)
    for width in (360, 1600):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert said == []


@pytest.mark.parametrize("name", [*GIVEN, "class"])
@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 360), ("dark", 1600)])
@pytest.mark.exhaustive
def test_axe_finds_nothing_on_any_page(page: Page, pages: Path, name: str, scheme: str, width: int) -> None:
    assert looked_at(page, pages, name, scheme, width) == []


@pytest.mark.parametrize(
    ("name", "scheme", "width"),
    [("failed", "light", 1280), ("failed", "dark", 360), ("class", "light", 360), ("class", "dark", 1280)],
)
def test_axe_finds_nothing(page: Page, pages: Path, name: str, scheme: str, width: int) -> None:
    assert looked_at(page, pages, name, scheme, width) == []


def looked_at(page: Page, pages: Path, name: str, scheme: str, width: int) -> list[str]:
    """What axe finds on a page with everything unfolded."""
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.set_viewport_size({"width": width, "height": 900})
    opened(page, pages, name)
    page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    return violations(page)


def test_axe_would_find_something(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    page.evaluate("document.querySelector('.play').textContent = ''")
    assert violations(page) != []


def test_the_page_follows_the_readers_light_and_dark(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    seen = []
    schemes: tuple[Literal["light", "dark"], ...] = ("light", "dark")
    for scheme in schemes:
        page.emulate_media(color_scheme=scheme)
        seen.append(page.evaluate("getComputedStyle(document.body).backgroundColor"))
    assert seen == ["rgb(255, 255, 255)", "rgb(20, 24, 29)"]


def test_on_paper_what_explains_is_open_and_the_player_is_gone(page: Page, pages: Path) -> None:
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


def names(page: Page) -> list[str]:
    return page.locator("#table tbody tr:visible th").all_inner_texts()


def test_the_class_table_sorts_up_and_down(page: Page, pages: Path) -> None:
    opened(page, pages, "class")
    order = [f"student{number}" for number in range(12)]
    assert names(page) == order
    page.get_by_role("button", name="submission").click()
    assert names(page) == order[::-1]
    page.get_by_role("button", name="submission").click()
    assert names(page) == order
    page.get_by_role("button", name="points").click()
    header = page.locator("#table th", has_text="points").first
    assert header.get_attribute("aria-sort") == "ascending"
    up = page.locator("#table tbody tr td:nth-child(2)").all_inner_texts()
    page.get_by_role("button", name="points").click()
    assert header.get_attribute("aria-sort") == "descending"
    down = page.locator("#table tbody tr td:nth-child(2)").all_inner_texts()
    values = [float(text.split()[0]) for text in up]
    assert values == sorted(values)
    assert [float(text.split()[0]) for text in down] == sorted(values, reverse=True)
    assert page.locator("#table [aria-sort]").count() == 1


def test_the_class_table_filters_by_name_verdict_and_check(page: Page, pages: Path) -> None:
    opened(page, pages, "class")
    shown = page.get_by_role("status")
    page.get_by_label("Verdict").select_option("passed")
    assert sorted(names(page)) == ["student0", "student4", "student8"]
    assert shown.inner_text() == "3 of 12 shown"
    page.get_by_label("Verdict").select_option("error")
    assert sorted(names(page)) == ["student11", "student3", "student7"]
    page.get_by_label("Verdict").select_option("")
    page.get_by_label("Failed check").select_option("03-circle-publisher/circle")
    assert sorted(names(page)) == ["student1", "student5", "student9"]
    page.get_by_label("Name").fill("T5")
    assert names(page) == ["student5"]


def test_a_class_page_leads_to_each_report(page: Page, pages: Path) -> None:
    (pages / "class.html").replace(pages / "class" / "index.html")
    try:
        page.goto((pages / "class" / "index.html").as_uri())
        page.get_by_role("link", name="student2", exact=True).first.click()
        assert page.inner_text("body") == "a page"
    finally:
        (pages / "class" / "index.html").replace(pages / "class.html")


@pytest.mark.parametrize("name", ["hostile", "enormous"])
def test_a_hostile_submission_runs_nothing(page: Page, pages: Path, name: str, said: list[str]) -> None:
    page.add_init_script("window.ran = []; window.pwned = (what) => window.ran.push(what);")
    opened(page, pages, name)
    page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    page.get_by_role("slider", name="Time").fill("3")
    assert page.evaluate("window.ran") == []
    assert said == []
    assert page.evaluate("document.scripts.length") == 2


def test_a_hostile_class_runs_nothing(page: Page, tmp_path: Path, said: list[str]) -> None:
    made = report("failed", submission=hostile().submission.name)
    bad = Finding(Status.FAILED, "</td><script>pwned(1)</script>", "", "<img src=x onerror=pwned(2)>", "<b>", None)
    outcomes = tuple(replace(each, title="<svg onload=pwned(3)>", finding=bad) for each in made.outcomes)
    (tmp_path / "a'\"><script>pwned(4)<.json").write_text(to_json(replace(made, outcomes=outcomes)), "utf-8")
    save_class_page(tmp_path, tmp_path / "class.html")
    page.add_init_script("window.ran = []; window.pwned = (what) => window.ran.push(what);")
    opened(page, tmp_path, "class")
    page.get_by_role("button", name="submission").click()
    assert page.evaluate("window.ran") == []
    assert said == []


def test_the_policy_stops_what_escaping_would_let_through(
    page: Page, pages: Path, tmp_path: Path, said: list[str]
) -> None:
    text = (pages / "passed.html").read_text("utf-8")
    scripts = (
        "<script>pwned(1)</script><img src=x onerror=pwned(2)><svg onload=pwned(3)></svg><b style='color:red'>x</b>"
        "<a id=bad href='javascript:pwned(4)'>x</a><iframe srcdoc='<script>parent.pwned(5)</script>'></iframe>"
    )
    (tmp_path / "bad.html").write_text(text.replace("<main", f"{scripts}<main"), "utf-8")
    page.add_init_script("window.ran = []; window.pwned = (what) => window.ran.push(what);")
    opened(page, tmp_path, "bad")
    page.locator("#bad").click()
    assert page.evaluate("window.ran") == []
    assert sum("Content Security Policy" in text for text in said) >= 4
    assert page.locator(".player").is_visible(), "our own script still runs"

"""The replay on the page of a submission, in a browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.report.pages import opened, turtle
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


def stop_clock(page: Page) -> None:
    """Stop the clock of the page. After that, the clock advances only when `page.clock.run_for` is called.

    Until it is paused, the clock runs, and it cannot be paused at a time that has passed.
    """
    page.clock.install(time=0)
    page.clock.pause_at(HANG_S)


def test_the_replay_moves_the_turtle_at_the_chosen_speed_and_ends(page: Page, pages: Path, problems: list[str]) -> None:
    stop_clock(page)
    opened(page, pages, "passed")
    rest = turtle(page)
    page.get_by_label("Speed").select_option("2")
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(1000)
    assert float(page.locator(".slider").input_value()) == pytest.approx(2.0, abs=0.3)
    x, y, degrees = turtle(page)
    # The first command arrives after 0.5 s, so after 2 s the turtle has turned left by 1.5 rad around (5.54, 7.54) m.
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
    assert problems == []


def test_speed_20_is_twenty_times_as_fast(page: Page, pages: Path) -> None:
    stop_clock(page)
    opened(page, pages, "passed")
    page.get_by_label("Speed").select_option("20")
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(250)
    assert float(page.locator(".slider").input_value()) == pytest.approx(5.0, abs=0.7)


def test_keys_move_the_slider_and_show_the_time(page: Page, pages: Path) -> None:
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


def test_the_path_so_far_ends_at_the_turtle(page: Page, pages: Path) -> None:
    opened(page, pages, "passed")
    page.get_by_role("slider", name="Time").fill("4")
    points = page.locator(".gone").get_attribute("points") or ""
    last = points.split()[-1].split(",")
    assert [float(each) for each in last] == pytest.approx(turtle(page)[:2], abs=0.2)


def test_a_turtle_with_a_nan_position_is_not_drawn(page: Page, pages: Path) -> None:
    opened(page, pages, "nan")
    page.get_by_role("slider", name="Time").fill("9")
    assert page.locator(".turtle").get_attribute("visibility") == "hidden"
    assert "not a number" in page.locator(".now").inner_text()
    page.get_by_role("slider", name="Time").fill("0.1")
    assert page.locator(".turtle").get_attribute("visibility") == "visible"

"""The interactive figures move like the simulator, and their text describes what they show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.book.figures import FIGURES
from grader.book.lesson import lessons
from grader.book.site import write_book
from grader.tests.book.served import served
from grader.tests.browser import browser_or_reason, launched, new_page, violations
from grader.turtlesim.turtle import FRAME_S, Turtle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page


class Nothing:
    """A canvas that ignores everything."""

    def color_at(self, _x: float, _y: float) -> tuple[int, int, int]:
        return (0, 0, 0)

    def line(self, *_: object) -> None:
        """Ignore the line."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    out = tmp_path_factory.mktemp("book")
    write_book(out)
    with served(out) as url, launched(browser_or_reason()) as browser:
        yield opened(browser, url)


def opened(browser: Browser, url: str) -> Page:
    tab = new_page(browser, viewport={"width": 1280, "height": 900})
    tab.goto(f"{url}03-circle-publisher/index.html")
    return tab


def step(page: Page, name: str) -> None:
    page.goto(page.url.replace(page.url.split("/")[-2], name))


def test_each_figure_stands_in_a_section_of_its_lesson() -> None:
    anchors = {lesson.id: {section.anchor for section in lesson.sections} for lesson in lessons()}
    for name, figure in FIGURES.items():
        assert figure.anchor in anchors[name]


@pytest.mark.parametrize(("v", "w"), [(2.0, 1.0), (1.5, -0.7), (-1.0, 2.0), (3.0, 0.0), (3.0, 0.4)])
def test_the_turtle_of_a_figure_moves_like_that_of_the_simulator(page: Page, v: float, w: float) -> None:
    step(page, "03-circle-publisher")
    poses = page.evaluate(
        "([v, w]) => import('../assets/motion.js').then(motion => motion.drive(motion.START, v, w, 4))", [v, w]
    )
    turtle = Turtle()
    for frame, pose in enumerate(poses[1:]):
        turtle.command(v, 0.0, w)
        turtle.update(FRAME_S, frame * FRAME_S, Nothing())
        assert pose["x"] == pytest.approx(turtle.x, abs=1e-6)
        assert pose["y"] == pytest.approx(turtle.y, abs=1e-6)


def test_the_sliders_change_the_circle_by_keyboard(page: Page) -> None:
    step(page, "03-circle-publisher")
    figure = page.locator("[data-figure='circle']")
    figure.get_by_text("Radius = |v / w| = 2.00 / 1.00 = 2.00 m.").wait_for()
    slider = figure.get_by_role("slider", name="linear.x")
    slider.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    figure.get_by_text("= 2.50 m. One turn takes 2π / |w| = 6.28 s.").wait_for()
    assert slider.get_attribute("aria-valuetext") == "2.5 m/s"
    # A short slider cannot be set precisely, also where the figure is narrow.
    page.set_viewport_size({"width": 700, "height": 900})
    assert all(
        width > 200
        for width in page.locator(".explore input").evaluate_all("all => all.map((each) => each.clientWidth)")
    )


@pytest.mark.parametrize(("v", "w", "side"), [(1, 1, "left"), (1, -1, "right"), (-1, 1, "right"), (-1, -1, "left")])
def test_the_text_names_the_side_of_the_circle(page: Page, v: int, w: int, side: str) -> None:
    """The turtle starts at an angle of 0, so its left is up."""
    step(page, "03-circle-publisher")
    text, y = page.evaluate(
        """async ([v, w]) => {
            const { FIGURES } = await import("../assets/figures.js");
            const { drive, START } = await import("../assets/motion.js");
            return [FIGURES.circle.draw({ v, w }).text, drive(START, v, w, 3).at(-1).y - START.y];
        }""",
        [v, w],
    )
    assert f"The circle is on the turtle's {side}." in text
    assert (y > 0) == (side == "left")


def test_the_other_figures_say_what_they_show(page: Page) -> None:
    step(page, "09-parameters")
    page.get_by_text("angular.z = speed / radius = 1.00 / 2.00 = 0.50 rad/s. One turn takes 12.57 s.").wait_for()
    step(page, "06-pose-subscriber")
    page.get_by_text("In the world, it is at x 4.28 m, y 7.84 m.").wait_for()
    assert violations(page) == []
    step(page, "07-challenges")
    page.get_by_text("Distance = hypot(5.50, -3.50) = 6.52 m.").wait_for()
    page.get_by_text("The turtle has to turn 1.07 rad to the right.").wait_for()
    page.set_viewport_size({"width": 360, "height": 800})
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    page.set_viewport_size({"width": 1280, "height": 900})

"""A learner solves step 03 in the page, after two mistakes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.browser import violations
from grader.tests.narrow import cut
from grader.tests.open.course import CIRCLE
from grader.tests.waiting import until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from grader.tests.open.course import Course


def verdict(page: Page, text: str) -> None:
    page.locator("#verdict-line").get_by_text(text).wait_for()


def stays(page: Page, key: str) -> None:
    """Mark an element, so that `stayed` detects whether it was replaced."""
    page.locator(f'[data-key="{key}"]').first.evaluate("each => { each.marked = true; }")


def stayed(page: Page, key: str) -> bool:
    return bool(page.locator(f'[data-key="{key}"]').first.evaluate("each => each.marked === true"))


def test_the_story_of_step_03(learner: Course, browser: Browser) -> None:
    page = learner.opened(browser)
    problems: list[str] = []
    page.on("console", lambda message: problems.append(message.text))
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.get_by_role("main").get_by_role("link", name="03 Draw a circle").click()

    # A lesson can be read before its step is started.
    page.get_by_role("heading", name="Why programs talk through topics").wait_for()
    page.get_by_role("button", name="Start this step").click()
    verdict(page, "Not passed yet: 15 of 100 points")
    assert learner.node.is_file()
    page.get_by_role("article").filter(has_text="The node has no publisher.").wait_for()
    assert page.locator("#checks li").count() > 10
    assert page.locator("#checks li.passed").count() > 5

    page.get_by_role("button", name="Hint").click()
    page.locator("#hints li").get_by_text("Three parts are missing").wait_for()

    stays(page, "package-xml")
    learner.save("2.0", "2")
    verdict(page, "Not passed yet")
    page.get_by_role("article").get_by_text("must be of type 'float'").first.wait_for()
    link = page.get_by_role("article").get_by_role("link", name="draw_circle.py:").first
    assert (link.get_attribute("href") or "").startswith(f"vscode://file{learner.workspace}")

    learner.save("2.0", "3.0")
    verdict(page, "50 of 100 points")
    page.get_by_role("article").filter(has_text="The turtle drives a circle").get_by_text("radius").first.wait_for()
    assert page.locator("#hints li").count() == 1
    stays(page, "run-1")
    # If a save changes nothing, the verdict is not replaced. Adding a comment replaces only the affected parts.
    learner.save("2.0", "3.0  # fast")
    page.locator(".line.marked").get_by_text("# fast").first.wait_for()
    assert stayed(page, "run-1")
    assert stayed(page, "package-xml")

    learner.save()
    verdict(page, "Passed: 100 of 100 points.")
    page.locator("#checks li.failed").first.wait_for(state="detached")
    page.locator("#details article").first.wait_for(state="detached")
    until(lambda: not stayed(page, "run-1"))  # the verdict comes before the trajectory
    page.get_by_role("button", name="Play").click()
    page.get_by_role("button", name="Pause").wait_for()
    assert page.locator(f'.steps [data-step="{CIRCLE}"]').get_by_text("100/100").is_visible()
    assert violations(page) == []

    page.get_by_role("button", name="Next step").click()
    page.get_by_role("heading", level=1, name="What makes a folder a package").wait_for()
    page.get_by_text("Verdict on step 04").wait_for()
    assert problems == []
    page.close()


def test_answers_get_no_picture_of_a_turtle_and_hints_show_code(learner: Course, browser: Browser) -> None:
    learner.run("start", "02")
    page = learner.opened(browser, "02-discover-topics/index.html")
    verdict(page, "0 of 100 points")
    page.get_by_role("article").filter(has_text="answers.toml has no answers yet.").wait_for()
    assert page.locator("#details [data-key^=run-]").count() == 0
    page.get_by_role("button", name="Hint").click()
    page.locator("#hints code").get_by_text("grader start 02", exact=True).wait_for()
    page.close()


def test_the_files_are_judged_before_the_trial(begun: Course, browser: Browser) -> None:
    page = begun.opened(browser)
    verdict(page, "Not passed yet")
    # While the package is built and run, the list already shows failures in the files.
    page.evaluate(
        """() => {
            globalThis.early = false;
            new MutationObserver(() => {
                const failed = document.querySelector('#checks li.failed')?.textContent ?? "";
                const doing = document.getElementById("doing").textContent;
                if (/never closed/.test(failed) && doing && !doing.startsWith("Drawing")) globalThis.early = true;
            }).observe(document.body, { subtree: true, childList: true, characterData: true });
        }"""
    )
    begun.save("rclpy.init(args=args)", "rclpy.init(args=args")
    page.get_by_role("article").get_by_text("never closed").first.wait_for()
    assert page.evaluate("globalThis.early")
    page.close()


def test_lines_that_the_step_needs_are_shown_until_they_are_added_and_hints_begin_with_them(
    begun: Course, browser: Browser
) -> None:
    setup = begun.node.parents[1] / "setup.py"
    whole = setup.read_text()
    begun.save()
    page = begun.opened(browser)
    setup.write_text("".join(line for line in whole.splitlines(keepends=True) if "draw_circle:main" not in line))
    page.locator("#task-state").get_by_text(
        "This step needs one more line in setup.py. Add this line to the list console_scripts"
    ).wait_for()
    page.get_by_role("article").filter(has_text="The package has no executable draw_circle.").first.wait_for()
    page.get_by_role("button", name="Hint").click()
    page.locator("#hints li").get_by_text("console_scripts in setup.py needs a line for draw_circle").wait_for()
    page.reload()
    page.locator("#task-state").get_by_text('"draw_circle = my_robot_controller.draw_circle:main"').wait_for()
    assert cut(page) == []
    setup.write_text(whole)
    verdict(page, "Passed: 100 of 100 points.")
    assert not page.locator("#task-state").get_by_text("This step needs").is_visible()
    assert page.locator("#hints li").count() == 0
    page.close()


@pytest.mark.parametrize(("scheme", "width"), [("dark", 1400), ("light", 360)])
def test_axe_finds_nothing_and_nothing_is_cut(begun: Course, browser: Browser, scheme: str, width: int) -> None:
    page = begun.opened(browser, width=width)
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    for name in ("Lesson", "Verdict", "Turtle"):
        button = page.get_by_role("button", name=name, exact=True)
        if button.is_visible():
            button.click()
        assert violations(page) == []
        assert cut(page) == []
        # On a wide screen the panes scroll, not the page.
        assert width < 1000 or page.evaluate("document.documentElement.scrollHeight <= innerHeight")
    page.close()


def test_every_pane_is_reached_by_keyboard(begun: Course, browser: Browser) -> None:
    begun.save("rclpy.init(args=args)", "rclpy.init(args=args")  # there are hints until the step is passed
    page = begun.opened(browser, width=360)
    page.get_by_role("button", name="Verdict", exact=True).focus()
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Hint", disabled=False).focus()
    page.keyboard.press("Enter")
    page.locator("#hints li").first.wait_for()
    page.close()


@pytest.mark.parametrize("width", [800, 1400])
def test_the_whole_lesson_is_printed_whatever_pane_is_shown(begun: Course, browser: Browser, width: int) -> None:
    page = begun.opened(browser, f"{CIRCLE}/index.html", width)
    page.get_by_role("button", name="Turtle", exact=True).click()
    page.emulate_media(media="print")
    assert page.get_by_role("heading", name="To think about").is_visible()
    assert not page.locator("#turtle-pane").is_visible()
    # The page ends after the lesson, not at the bottom of the window.
    assert page.evaluate("document.documentElement.scrollHeight") > 4000
    page.close()


def test_two_browsers_show_the_same_verdict_and_hints(begun: Course, browser: Browser) -> None:
    problems: list[str] = []
    first, second = (begun.opened(browser) for _ in range(2))
    for page in (first, second):
        page.on("console", lambda message: problems.append(message.text))
        page.on("pageerror", lambda error: problems.append(str(error)))
    begun.save("2.0", "3.0")
    for page in (first, second):
        verdict(page, "Not passed yet")
    first.get_by_role("button", name="Hint").click()
    until(lambda: 0 < first.locator("#hints li").count() == second.locator("#hints li").count())
    first.close()
    begun.save()
    verdict(second, "Passed: 100 of 100 points.")
    again = begun.opened(browser)
    verdict(again, "Passed: 100 of 100 points.")
    assert problems == []
    again.close()
    second.close()


def test_a_page_that_asks_before_the_details_are_drawn_gets_them_later(begun: Course, browser: Browser) -> None:
    begun.save("2.0", "3.0")
    page = begun.opened(browser)
    verdict(page, "Not passed yet")
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    # This is the server's response until the details are drawn.
    page.route("**/verdict", lambda route: route.fulfill(content_type="text/html", body=""), times=1)
    with page.expect_response("**/verdict"):
        page.reload()
    begun.save()
    page.locator("#details [data-key]").first.wait_for()
    assert problems == []
    page.close()

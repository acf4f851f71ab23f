"""The page of a class in a browser: sorting, filtering and links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.report.pages import opened

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


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


def test_a_class_page_links_to_each_report(page: Page, pages: Path) -> None:
    (pages / "class.html").replace(pages / "class" / "index.html")
    try:
        page.goto((pages / "class" / "index.html").as_uri())
        page.get_by_role("link", name="student2", exact=True).first.click()
        assert page.inner_text("body") == "a page"
    finally:
        (pages / "class" / "index.html").replace(pages / "class.html")

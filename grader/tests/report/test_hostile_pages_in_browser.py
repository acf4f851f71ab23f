"""Pages of hostile submissions in a browser: none of their scripts runs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Status
from grader.report.html_class import save_class_page
from grader.report.json import to_json
from grader.tests.report.hostile import hostile
from grader.tests.report.pages import opened, unfold
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


@pytest.mark.parametrize("name", ["hostile", "enormous"])
def test_a_hostile_submission_runs_no_script(page: Page, pages: Path, name: str, problems: list[str]) -> None:
    page.add_init_script("window.ran = []; window.pwned = (what) => window.ran.push(what);")
    opened(page, pages, name)
    unfold(page)
    page.get_by_role("slider", name="Time").fill("3")
    assert page.evaluate("window.ran") == []
    assert problems == []
    assert page.evaluate("document.scripts.length") == 2


def test_a_hostile_class_runs_no_script(page: Page, tmp_path: Path, problems: list[str]) -> None:
    made = report("failed", submission=hostile().submission.name)
    bad = Finding(Status.FAILED, "</td><script>pwned(1)</script>", "", "<img src=x onerror=pwned(2)>", "<b>", None)
    outcomes = tuple(replace(each, title="<svg onload=pwned(3)>", finding=bad) for each in made.outcomes)
    (tmp_path / "a'\"><script>pwned(4)<.json").write_text(to_json(replace(made, outcomes=outcomes)), "utf-8")
    save_class_page(tmp_path, tmp_path / "class.html")
    page.add_init_script("window.ran = []; window.pwned = (what) => window.ran.push(what);")
    opened(page, tmp_path, "class")
    page.get_by_role("button", name="submission").click()
    assert page.evaluate("window.ran") == []
    assert problems == []


def test_the_policy_stops_scripts_that_were_not_escaped(
    page: Page, pages: Path, tmp_path: Path, problems: list[str]
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
    assert sum("Content Security Policy" in text for text in problems) >= 4
    assert page.locator(".player").is_visible(), "our own script did not run"

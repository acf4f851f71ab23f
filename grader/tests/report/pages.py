"""Submissions whose pages are opened in a browser, and the actions of the tests on a page."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.tests.checks.made import evidence, node
from grader.tests.checks.shapes import SHAPES
from grader.tests.report.hostile import enormous, hostile
from grader.tests.report.reports import EVIDENCE

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

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


def opened(page: Page, pages: Path, name: str) -> Page:
    """Open the page with this name."""
    page.goto((pages / f"{name}.html").as_uri())
    return page


def unfold(page: Page) -> None:
    """Open every section that can be folded."""
    page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")


def turtle(page: Page) -> tuple[float, float, float]:
    """Return the position of the drawn turtle (x, y) and the angle by which it is turned (degrees)."""
    transform = page.locator(".turtle").get_attribute("transform") or ""
    x, y, degrees = map(float, re.findall(r"-?[\d.]+", transform))
    return x, y, degrees

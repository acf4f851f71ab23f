"""Find the parts of a page that a narrow window cuts off."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

WIDTHS = (390, 320)
"""The widths of a common and of a small phone (CSS pixels)."""
_FIND = """
async () => {
  // The page chooses the layout of a graph or a plot in the frame after the window has changed.
  await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const found = [];
  const name = (each) => `${each.localName}#${each.id}.${each.getAttribute("class") ?? ""} ${each.ariaLabel ?? ""}`;
  const page = document.documentElement;
  if (page.scrollWidth > innerWidth) found.push(`the page is ${page.scrollWidth} px wide`);
  for (const each of document.body.querySelectorAll("*")) {
    const style = getComputedStyle(each);
    // Text for screen readers is clipped on purpose.
    if (style.clipPath !== "none" || each.closest("svg *")) continue;
    if (!each.checkVisibility({ visibilityProperty: true })) continue;
    const box = each.getBoundingClientRect();
    if (box.right > innerWidth + 1 && box.left < innerWidth) found.push(`${name(each)} ends outside of the window`);
    const fits = each.scrollWidth <= each.clientWidth + 1 || style.overflowX === "visible";
    if (fits || each.matches("input, textarea")) continue;
    found.push(`${name(each)} is ${each.scrollWidth} px wide in ${each.clientWidth} px`);
  }
  return found;
}
"""


def cut(page: Page) -> list[str]:
    """Return the visible parts of the page that are cut, or that scroll sideways, on a phone, as text."""
    before = page.viewport_size
    found: list[str] = []
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 800})
        found += [f"{width} px: {each}" for each in page.evaluate(_FIND)]
    if before:
        page.set_viewport_size(before)
    return found


_TEXT_SIZE = """(selector) => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve(
  Math.min(...[...document.querySelectorAll(`${selector} text`)].map((text) =>
    parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a))))))
"""


def text_px(page: Page, selector: str) -> float:
    """Return the smallest font size of the text in a drawing on a phone (CSS pixels)."""
    before = page.viewport_size
    page.set_viewport_size({"width": WIDTHS[0], "height": 800})
    found: float = page.evaluate(_TEXT_SIZE, selector)
    if before:
        page.set_viewport_size(before)
    return found

"""Limit nbgrader's pages to the text and pictures of a student's notebook, without scripts or styles.

nbgrader shows feedback and the formgrader in the browser of an instructor, who is logged in to Jupyter. nbgrader's
templates insert HTML from Markdown and outputs into these pages without escaping the HTML.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bleach
from nbconvert.filters import markdown2html

if TYPE_CHECKING:
    from traitlets.config import Config

SHOWN = ["image/png", "image/jpeg", "text/plain"]
"""The kinds of output that are shown, by priority."""
TAGS = {
    *bleach.sanitizer.ALLOWED_TAGS,
    *("br", "code", "del", "div", "h1", "h2", "h3", "h4", "h5", "h6", "hr", "p", "pre", "span", "sub", "sup"),
    *("table", "tbody", "td", "th", "thead", "tr"),
}
ATTRIBUTES = {**bleach.sanitizer.ALLOWED_ATTRIBUTES, "span": ["class"], "div": ["class"]}


def safe_html(markdown: str) -> str:
    """Render Markdown as HTML with only the allowed tags and attributes."""
    return str(bleach.clean(markdown2html(markdown), tags=TAGS, attributes=ATTRIBUTES, strip=True))


def configure_pages(config: Config) -> None:
    """Configure nbgrader's pages to show only harmless content."""
    config.HTMLExporter.sanitize_html = True
    config.HTMLExporter.filters = {"markdown2html": safe_html}
    config.NbConvertBase.display_data_priority = SHOWN

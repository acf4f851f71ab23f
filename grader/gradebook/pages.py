"""Limit nbgrader's pages to the text of a student's notebook and the pictures in its outputs.

The pages contain no scripts or styles from the notebook, and no pictures from its Markdown.

nbgrader shows feedback and the formgrader in the browser of an instructor, who is logged in to Jupyter. nbgrader's
templates insert HTML from Markdown and outputs into these pages without escaping the HTML.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bleach
from nbconvert.filters import get_metadata
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath

if TYPE_CHECKING:
    from traitlets.config import Config

SHOWN = ["image/png", "image/jpeg", "text/plain"]
"""The MIME types that are shown, in order of priority."""
TAGS = {
    *bleach.sanitizer.ALLOWED_TAGS,
    *("br", "code", "del", "div", "h1", "h2", "h3", "h4", "h5", "h6", "hr", "p", "pre", "span", "sub", "sup"),
    *("table", "tbody", "td", "th", "thead", "tr"),
}
ATTRIBUTES = {**bleach.sanitizer.ALLOWED_ATTRIBUTES, "span": ["class"], "div": ["class"]}


class _NoPictures(dict[str, dict[str, str]]):
    """Empty pictures in place of a cell's attachments. nbconvert raises an error if an attached picture is missing."""

    def __contains__(self, name: object) -> bool:
        return True

    def __missing__(self, name: str) -> dict[str, str]:
        return {SHOWN[0]: ""}


def safe_html(markdown: str) -> str:
    """Render Markdown as HTML with only the allowed tags and attributes. Pictures are left out."""
    renderer = IPythonRenderer(escape=False, attachments=_NoPictures())
    html = MarkdownWithMath(renderer=renderer).render(markdown)
    return str(bleach.clean(html, tags=TAGS, attributes=ATTRIBUTES, strip=True))


def safe_metadata(output: Any, key: str, mimetype: str | None = None) -> float | None:  # noqa: ANN401 - nbformat's output
    """Return a value from the metadata of a picture, such as its width, if it is a number, or else None.

    nbconvert's templates insert these values without quotes, so a string could add attributes to the element.
    """
    try:
        value = get_metadata(output, key, mimetype)  # type: ignore[no-untyped-call]
    except AttributeError:
        return None  # the kernel sent something other than an object
    return value if type(value) in (int, float) else None


def configure_pages(config: Config) -> None:
    """Configure nbgrader's pages to show only harmless content."""
    config.HTMLExporter.sanitize_html = True
    config.HTMLExporter.filters = {"markdown2html": safe_html, "get_metadata": safe_metadata}
    config.NbConvertBase.display_data_priority = SHOWN

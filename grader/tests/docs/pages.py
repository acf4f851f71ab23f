"""The pages of the documentation, and the anchors of their headings."""

from __future__ import annotations

import re
from pathlib import Path

from grader.authoring.console_blocks import FENCE

ROOT = Path(__file__).resolve().parents[3]
TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
BESIDE_THE_CODE = ("grader/checks/README.md", "grader/classroom/templates/README.md")
PAGES = (*TOP, *sorted(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md")))
_HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)


def text_of(page: str) -> str:
    """Return the page's text."""
    return (ROOT / page).read_text("utf-8")


def prose_of(page: str) -> str:
    """Return the page's text without its fenced blocks."""
    return FENCE.sub("", text_of(page))


def anchors_of(path: Path) -> set[str]:
    """Return the anchors of the headings of a Markdown file, as GitHub and MyST create them."""
    headings = _HEADING.findall(FENCE.sub("", path.read_text("utf-8")))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}

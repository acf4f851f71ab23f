"""Configuration of Sphinx for README, docs/ and the lessons. `make docs` builds the site from the repository's root."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "ROS 2 topics, graded by doing"
extensions = ["myst_parser"]
root_doc = "README"
PAGES = {
    "Learn": ["docs/learner", "course/*/lesson", "docs/commands", "docs/glossary", "docs/ros2-differences"],
    "Teach": ["docs/instructor", "grader/classroom/templates/README", "docs/security", "docs/sandbox"],
    "Write exercises": ["docs/authors", "docs/kinds", "grader/checks/README"],
    "Project": [
        "docs/design",
        "docs/development",
        "docs/costs",
        "docs/strangers",
        "CONTRIBUTING",
        "SECURITY",
        "CHANGELOG",
    ],
}
"""The contents of the site, by caption."""
include_patterns = ["README.md", *(f"{page}.md" for pages in PAGES.values() for page in pages)]
html_theme = "furo"
html_title = project
html_show_copyright = False
html_static_path = ["site.css"]
html_css_files = ["site.css"]
# The same anchors as on GitHub, so that a link works in both places.
myst_heading_anchors = 4


def add_contents(_: Sphinx, name: str, source: list[str]) -> None:
    """Add the table of contents to README. GitHub shows README without it."""
    if name == root_doc:
        for caption, pages in PAGES.items():
            lines = "\n".join(f"/{page}" for page in pages)
            source[0] += f"\n```{{toctree}}\n:hidden:\n:glob:\n:caption: {caption}\n\n{lines}\n```\n"


def add_index(app: Sphinx, error: Exception | None) -> None:
    """Write an index page that leads to README."""
    if error is None:
        text = f'<!DOCTYPE html><title>{project}</title><meta http-equiv="refresh" content="0; url={root_doc}.html">\n'
        Path(app.outdir, "index.html").write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> None:
    """Register the functions above. Sphinx calls this function."""
    app.connect("source-read", add_contents)
    app.connect("build-finished", add_index)

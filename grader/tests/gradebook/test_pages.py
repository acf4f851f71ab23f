"""nbgrader's pages show the text of a student's notebook, and browsers run no script in it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from nbconvert.exporters import HTMLExporter
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from nbgrader.server_extensions import formgrader
from traitlets.config import Config

from grader.gradebook.pages import configure_pages

SCRIPT = "<script>steal()</script>"
OUTPUTS: tuple[dict[str, str], ...] = (
    {"text/html": SCRIPT, "text/plain": "plain"},
    {"image/svg+xml": "<svg onload=steal()>"},
    {"image/png": f'">{SCRIPT}'},
    {"text/latex": SCRIPT},
    {"text/markdown": SCRIPT},
    {"application/javascript": "steal()"},
)
WIDGETS = {"application/vnd.jupyter.widget-state+json": {"state": {"a": f"</script>{SCRIPT}"}}}
PICTURES = "![a](attachment:a.png)![b](attachment:b.svg)![c](data:image/svg+xml,<svg onload=steal()>)"
SIZES: tuple[dict[str, Any], ...] = (
    {"image/png": {"width": "1 onerror=steal()", "height": 2}},
    {"image/png": {"height": "1 onerror=steal()"}, "width": 3},
    {"width": "1 onerror=steal()", "needs_background": "x onerror=steal()", "alt": "' onerror='steal()"},
    {"image/png": ["onerror=steal()"]},
)
"""Metadata that a kernel can send with each picture."""
RESOURCES = {
    "nbgrader": {"notebook": "n", "assignment": "a", "student": "s"},
    **dict.fromkeys(("notebook_id", "assignment_id", "submission_id", "base_url", "mathjax_url"), "x"),
    "index": 0,
    "total": 1,
}


def cells() -> list[Any]:
    made = [
        new_markdown_cell(f"{SCRIPT}\n\n# Title\n\n<a href='javascript:steal()' onclick='steal()'>x</a>{PICTURES}"),  # type: ignore[no-untyped-call]
        new_code_cell(  # type: ignore[no-untyped-call]
            SCRIPT,
            outputs=[
                *(new_output("display_data", data=data) for data in OUTPUTS),  # type: ignore[no-untyped-call]
                *(new_output("display_data", data={"image/png": "AAAA"}, metadata=size) for size in SIZES),  # type: ignore[no-untyped-call]
                new_output("stream", text=SCRIPT),  # type: ignore[no-untyped-call]
            ],
        ),
    ]
    for number, cell in enumerate(made):
        about = {"grade": False, "solution": False, "locked": False, "task": False, "grade_id": str(number)}
        cell.metadata["nbgrader"] = about
    return made


@pytest.mark.filterwarnings("ignore:Your element with mimetype")
def test_nothing_of_a_notebook_is_a_script_in_the_formgrader() -> None:
    config = Config()
    configure_pages(config)
    config.HTMLExporter.template_name = "formgrade"
    config.HTMLExporter.extra_template_basedirs = [str(Path(formgrader.__file__).parent / "templates")]
    notebook = new_notebook(cells=cells(), metadata={"widgets": WIDGETS, "title": SCRIPT})  # type: ignore[no-untyped-call]
    exporter = HTMLExporter(config=config)  # type: ignore[no-untyped-call]
    page, _ = exporter.from_notebook_node(notebook, resources={**RESOURCES})
    assert "plain" in page
    assert "<h1>Title" in page
    assert "steal()" in page  # the script is shown as text
    assert 'height="2"' in page
    assert 'width="3"' in page
    assert re.findall(r"<img[^>]* on\w+=", page) == []
    assert re.findall(r"<script[^>]*>\s*steal|(?:href|src|on\w+)\s*=\s*[\"']?[^\"'>]*steal|<svg onload", page) == []

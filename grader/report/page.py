"""A page of one file: template, style and script put together under a Content-Security-Policy that allows just them.

The policy names the style and the script by their hashes, so that nothing else on the page can run or load, whatever
a submission holds; what a student wrote is escaped all the same.
"""

from __future__ import annotations

import base64
import hashlib
import json
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.report.files import not_written
from grader.report.template import ASSETS, fill

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


def make_page(template: str, script: str, data: object, values: Mapping[str, object]) -> str:
    """The page of a template with the style sheet, a script (a file of assets/ each) and the data that it reads."""
    style, code = _text("page.css"), _text(script)
    policy = (
        f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(code)}; img-src data:; base-uri 'none'; "
        "form-action 'none'; require-trusted-types-for 'script'; trusted-types 'none'"
    )
    parts = {"policy": policy, "style": Markup(style), "script": Markup(code), "data": _json(data)}
    return fill(template, {**values, **parts})


def save_page(page: str, file: Path) -> None:
    """Write a page. Raises the error of `not_written` where that cannot be done."""
    try:
        file.write_text(page, encoding="utf-8", errors="replace")
    except OSError as error:
        raise not_written(file, error) from error


def _text(name: str) -> str:
    return (ASSETS / name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _json(data: object) -> Markup:
    """JSON that no HTML parser can mistake for the end of its element."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))

"""Make a single-file page from a template, a style sheet and a script, with a strict Content-Security-Policy.

The policy allows the style sheet and the script by their hashes, and images that are part of the page. Nothing else on
the page can run or be loaded, regardless of what a submission contains. All text from a student is also escaped.
"""

from __future__ import annotations

import base64
import hashlib
import json
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.report.escaped_template import ASSETS, fill
from grader.report.output_file import write

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path


def make_page(template: str, scripts: Sequence[str], data: object, values: Mapping[str, object]) -> str:
    """Return a page with the style sheet, scripts and their data.

    `template` and `scripts` are the names of files in assets/.
    """
    style, code = _text("page.css"), "".join(map(_text, scripts))
    policy = (
        f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(code)}; img-src data:; base-uri 'none'; "
        "form-action 'none'; require-trusted-types-for 'script'; trusted-types 'none'"
    )
    parts = {"policy": policy, "style": Markup(style), "script": Markup(code), "data": script_json(data)}
    return fill(template, {**values, **parts})


def save_page(page: str, file: Path) -> None:
    """Write a page. Raises the same errors as `output_file.write`."""
    write(file, page.encode("utf-8", "replace"))


def _text(name: str) -> str:
    return (ASSETS / name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def script_json(data: object) -> Markup:
    """Return JSON in which no HTML parser can find an end tag of the script element."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))

"""Fill in the templates in assets/. All values except Markup are escaped, and a missing value is an error."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup, escape

from grader.report.plain import plain_line

if TYPE_CHECKING:
    from collections.abc import Mapping

ASSETS = Path(__file__).parent / "assets"
_CODE = re.compile(r"`([^`]+)`")


def fill(template: str, values: Mapping[str, object], *folders: Path) -> str:
    """Return the text of a template with these values. Raises jinja2.UndefinedError if a value is missing."""
    return compiled(template, *folders).render(values)


@cache
def compiled(template: str, *folders: Path) -> Template:
    """Return the compiled template. Call this before forking a child process, because compiling is slow.

    Templates are looked up in `folders`, and then in the assets of the reports.
    """
    environment = Environment(
        loader=FileSystemLoader([*folders, ASSETS]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["plain"] = plain_line
    environment.filters["with_code"] = with_code
    return environment.get_template(template)


def with_code(text: str) -> Markup:
    """Return a message as one line of HTML, in which text between backticks is marked as code.

    All of the text is escaped.
    """
    pieces = enumerate(_CODE.split(plain_line(text)))
    return Markup().join(Markup("<code>{}</code>").format(piece) if at % 2 else escape(piece) for at, piece in pieces)

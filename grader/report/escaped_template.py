"""Fill in the templates in assets/. All values are escaped, and a missing value is an error."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template

from grader.report.plain import plain_line

if TYPE_CHECKING:
    from collections.abc import Mapping

ASSETS = Path(__file__).parent / "assets"


def fill(template: str, values: Mapping[str, object], *folders: Path) -> str:
    """Return the text of a template with these values. Raises jinja2.UndefinedError if a value is missing."""
    return compiled(template, *folders).render(values)


@cache
def compiled(template: str, *folders: Path) -> Template:
    """Return the compiled template. Compile it before forking a child process, because compiling is slow.

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
    return environment.get_template(template)

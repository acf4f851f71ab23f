"""The templates of assets/, filled in: all that is put into one is escaped, and a name that it lacks is an error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from grader.report.plain import plain_line

if TYPE_CHECKING:
    from collections.abc import Mapping

ASSETS = Path(__file__).parent / "assets"


def fill(template: str, values: Mapping[str, object]) -> str:
    """The text of a template with these values. Raises jinja2.UndefinedError where it asks for another."""
    environment = Environment(
        loader=FileSystemLoader(ASSETS),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["plain"] = plain_line
    return environment.get_template(template).render(values)

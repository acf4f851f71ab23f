"""Read the files that the grader writes about a class.

The readers imitate a spreadsheet, Gradescope and the runner of GitHub Actions.
"""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import dataclass
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import jsonschema  # type: ignore[import-untyped]
from markdown_it import MarkdownIt

from grader.report.csv import to_csv
from grader.report.gradescope import to_gradescope

if TYPE_CHECKING:
    from grader.report.report import Report

VISIBILITY = {"enum": ["hidden", "after_due_date", "after_published", "visible"]}
FORMAT = {"enum": ["text", "html", "simple_format", "md", "ansi"]}
RESULTS: dict[str, Any] = {
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "score": {"type": "number"},
        "execution_time": {"type": "number"},
        "output": {"type": "string"},
        "output_format": FORMAT,
        "test_output_format": FORMAT,
        "test_name_format": FORMAT,
        "visibility": VISIBILITY,
        "stdout_visibility": VISIBILITY,
        "extra_data": {"type": "object"},
        "leaderboard": {"type": "array"},
        "tests": {
            "type": "array",
            "items": {
                "type": "object",
                "additionalProperties": False,
                "dependentRequired": {"max_score": ["score"]},
                "properties": {
                    "score": {"type": "number"},
                    "max_score": {"type": "number", "minimum": 0},
                    "status": {"enum": ["passed", "failed"]},
                    "name": {"type": "string"},
                    "name_format": FORMAT,
                    "number": {"type": "string"},
                    "output": {"type": "string"},
                    "output_format": FORMAT,
                    "tags": {"type": "array", "items": {"type": "string"}},
                    "visibility": VISIBILITY,
                    "extra_data": {"type": "object"},
                },
            },
        },
    },
    "anyOf": [{"required": ["score"]}, {"properties": {"tests": {"items": {"required": ["score"]}}}}],
}
"""The keys of "Autograder Specifications", "Output Format", with the values that Gradescope allows."""


def table(*reports: tuple[str, Report]) -> list[dict[str, str]]:
    """Return the rows of the CSV table."""
    text = to_csv(
        (student, each, "0.1.0 abc", f"reports/{number}.json", "") for number, (student, each) in enumerate(reports)
    )
    return list(csv.DictReader(io.StringIO(text.removeprefix("\ufeff"), newline="")))


def gradescope(given: Report) -> dict[str, Any]:
    """Return the content of results.json, checked against Gradescope's specification."""
    data: dict[str, Any] = json.loads(to_gradescope(given))
    jsonschema.validate(data, RESULTS)
    return data


@dataclass(frozen=True)
class Command:
    """A workflow command."""

    name: str
    properties: dict[str, str]
    message: str


def commands(log: str) -> list[Command]:
    """Return every workflow command in a log, in both forms of the syntax, as the runner finds it.

    The source is "Workflow commands for GitHub Actions" and ActionCommand.cs of actions/runner.
    """
    found = []
    for line in re.split(r"\r\n|\r|\n", log):
        new = re.match(r"\s*::([^\s:]+)(?: ([^:]*(?::(?!:)[^:]*)*?))?::(.*)$", line)
        if new:
            pairs = [pair.partition("=") for pair in (new[2] or "").split(",") if pair]
            properties = {name: unescaped(value, more=True) for name, _, value in pairs}
            found.append(Command(new[1], properties, unescaped(new[3])))
        elif old := re.search(r"##\[([^\]]+)\](.*)$", line):
            found.append(Command(f"old {old[1]}", {}, old[2]))
    return found


def unescaped(text: str, *, more: bool = False) -> str:
    signs = {"%0D": "\r", "%0A": "\n", **({"%3A": ":", "%2C": ","} if more else {}), "%25": "%"}
    return re.sub("|".join(signs), lambda match: signs[match[0]], text)


class Elements(HTMLParser):
    """The elements of a page, the addresses of its links and images, and the text of its table cells."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.elements: set[str] = set()
        self.addresses: list[str] = []
        self.cells: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.add(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("href", "src")]
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_data(self, data: str) -> None:
        if self.cells:
            self.cells[-1] = (self.cells[-1] + data).strip()


def shown(markdown: str) -> Elements:
    """Render Markdown in the same way as GitHub, including tables and HTML."""
    return Elements(MarkdownIt("gfm-like", {"html": True, "linkify": False}).render(markdown))

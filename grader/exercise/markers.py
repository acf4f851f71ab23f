"""Marked regions: the parts of a solution that students write themselves, and the text that replaces them.

    # BEGIN SOLUTION
    self.timer = self.create_timer(0.5, self.send)
    # END SOLUTION
    # BEGIN STARTER
    # # TODO: create a timer.
    # END STARTER

The released file contains the text of the STARTER block, without the comment signs, instead of the two blocks. In XML,
Markdown and HTML, the markers of a SOLUTION block are comments, and a STARTER block is one comment. Since comments
cannot be nested, `<! text !>` in a STARTER block becomes a comment:

    <!-- BEGIN SOLUTION -->
    <depend>geometry_msgs</depend>
    <!-- END SOLUTION -->
    <!-- BEGIN STARTER
    <! TODO: what else does the node import? !>
    END STARTER -->
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePosixPath

from grader.errors import UsageError


@dataclass(frozen=True)
class Syntax:
    """The comment syntax of a file type: the patterns of the marker lines, and how to uncomment a STARTER block."""

    markers: dict[str, re.Pattern[str]]
    line_sign: str
    """The prefix of every line in a STARTER block. The prefix is empty if the whole block is one comment."""


HASH = Syntax(
    {
        name: re.compile(rf"\s*#+ *{name}\s*")
        for name in ("BEGIN SOLUTION", "END SOLUTION", "BEGIN STARTER", "END STARTER")
    },
    "#",
)
ANGLE = Syntax(
    {
        "BEGIN SOLUTION": re.compile(r"\s*<!-- *BEGIN SOLUTION *-->\s*"),
        "END SOLUTION": re.compile(r"\s*<!-- *END SOLUTION *-->\s*"),
        "BEGIN STARTER": re.compile(r"\s*<!-- *BEGIN STARTER\s*"),
        "END STARTER": re.compile(r"\s*END STARTER *-->\s*"),
    },
    "",
)
SYNTAX = {
    **dict.fromkeys((".py", ".toml", ".cfg", ".ini", ".yaml", ".yml", ".sh", ".txt"), HASH),
    **dict.fromkeys((".xml", ".md", ".html"), ANGLE),
}
MEANT = re.compile(r"(?:begin|end)[ _-]*(?:solution|starter)", re.IGNORECASE)
"""Matches lines that look like a marker, such as `# begin-solution`. If such a line is not a marker, it is an error:
otherwise, a typo could release the solution to students."""


@dataclass(frozen=True)
class Region:
    """One region: the lines of the solution and the lines that replace them. `line` is the line of BEGIN SOLUTION."""

    line: int
    solution: tuple[str, ...]
    starter: tuple[str, ...]


def syntax_of(path: str) -> Syntax | None:
    """Return the comment syntax of a file, based on its suffix, or None if such files cannot contain regions."""
    return SYNTAX.get(PurePosixPath(path).suffix)


def regions(text: str, syntax: Syntax, name: str) -> list[str | Region]:
    """Split the text into lines (with line endings) and regions. Raises UsageError if a marker or block is wrong."""
    return _Reader(syntax, name).read(text)


def stripped(text: str, syntax: Syntax, name: str) -> str:
    """Return the text for students. Raises the same error as `regions`."""
    return "".join("".join(part.starter) if isinstance(part, Region) else part for part in regions(text, syntax, name))


def solved(text: str, syntax: Syntax, name: str) -> str:
    """Return the complete solution, without the markers. Raises the same error as `regions`."""
    return "".join("".join(part.solution) if isinstance(part, Region) else part for part in regions(text, syntax, name))


class _Reader:
    """Reads a text line by line.

    `self.inside` is the kind of the open block, and `self.since` is the line where that block began.
    """

    def __init__(self, syntax: Syntax, name: str) -> None:
        self.syntax = syntax
        self.name = name
        self.parts: list[str | Region] = []
        self.inside: str | None = None
        self.since = 0
        self.lines: list[str] = []

    def read(self, text: str) -> list[str | Region]:
        for number, line in enumerate(text.splitlines(keepends=True), 1):
            marker = next((name for name, shape in self.syntax.markers.items() if shape.fullmatch(line)), None)
            if marker is None:
                self._line(number, line)
            elif marker.startswith("BEGIN"):
                self._begin(number, marker.removeprefix("BEGIN "))
            else:
                self._end(number, marker.removeprefix("END "))
        if self.inside is not None:
            raise self._error(self.since, f"BEGIN {self.inside} has no END {self.inside}")
        return self.parts

    def _line(self, number: int, line: str) -> None:
        if MEANT.search(line):
            raise self._error(
                number, f"{line.strip()!r} looks like a marker, but is not one; see grader/exercise/markers.py"
            )
        if self.inside is None:
            self.parts.append(line)
        elif self.inside == "SOLUTION":
            self.lines.append(line)
        else:
            self.lines.append(self._freed(number, line))

    def _begin(self, number: int, block: str) -> None:
        if self.inside is not None:
            raise self._error(number, f"BEGIN {block} inside the {self.inside} block that begins on line {self.since}")
        if block == "STARTER":
            while self.parts and isinstance(self.parts[-1], str) and not self.parts[-1].strip():
                self.parts.pop()
            last = self.parts[-1] if self.parts else None
            if not isinstance(last, Region) or last.starter:
                raise self._error(number, "BEGIN STARTER belongs right below an END SOLUTION")
        self.inside, self.since, self.lines = block, number, []

    def _end(self, number: int, block: str) -> None:
        if self.inside != block:
            raise self._error(number, f"END {block} without a BEGIN {block}")
        if block == "SOLUTION":
            self.parts.append(Region(self.since, tuple(self.lines), ()))
        else:
            region = self.parts[-1]
            assert isinstance(region, Region)
            self.parts[-1] = Region(region.line, region.solution, tuple(self.lines))
        self.inside = None

    def _freed(self, number: int, line: str) -> str:
        if not self.syntax.line_sign:
            return line.replace("<!", "<!--").replace("!>", "-->")
        indent, sign, rest = line.partition(self.syntax.line_sign)
        if not line.strip():
            return line
        if not sign or indent.strip():
            raise self._error(number, f"each line of a STARTER block must begin with {self.syntax.line_sign!r}")
        text = rest.removeprefix(" ")
        return indent + text if text.strip() else text

    def _error(self, number: int, what: str) -> UsageError:
        return UsageError(f"{self.name}:{number}: {what}.")

"""An excerpt of a submission's file: the lines around a given line, with syntax colours."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.report.coloured_code import coloured
from grader.report.plain import LONGEST_LINE, plain_line, size

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.report.coloured_code import Piece
    from grader.submission.where import Where

AROUND = 4
"""The number of lines that are shown before and after the line."""
MOST_COLOURED = 60_000
"""The maximum length of the text from the beginning of the file to the end of the excerpt (characters). Colouring a
longer text would take too long."""

NEWLINE = re.compile(r"\r\n|\r|\n")
"""The line endings that Python recognizes. str.splitlines recognizes more line endings, so it would count lines
differently."""


@dataclass(frozen=True)
class CodeLine:
    """A line with its number, in coloured pieces. `marked` is true for the line that a check points to."""

    number: int
    pieces: tuple[Piece, ...]
    marked: bool


@dataclass(frozen=True)
class Excerpt:
    """A few consecutive lines of a file."""

    file: str
    lines: tuple[CodeLine, ...]

    @property
    def size(self) -> int:
        """The approximate size of the excerpt in a page, in bytes."""
        return sum(size(text) + 24 * bool(kind) for line in self.lines for kind, text in line.pieces)


def excerpt(evidence: Evidence, where: Where | None) -> Excerpt | None:
    """Return the lines around `where`, or None if `where` does not point to a line of the submission."""
    if where is None or where.line is None:
        return None
    data = evidence.submission.files.get(where.file)
    if data is None:
        return None
    text = data.decode("utf-8-sig", "replace")
    lines = NEWLINE.split(text)
    if not 1 <= where.line <= len(lines):
        return None
    first, last = max(where.line - AROUND, 1), min(where.line + AROUND, len(lines))
    pieces = _coloured("\n".join(lines[:last])) if where.file.endswith(".py") else []
    shown = []
    for number in range(first, last + 1):
        raw = lines[number - 1]
        fits = number <= len(pieces) and len(raw) <= LONGEST_LINE
        line = [(kind, plain_line(part)) for kind, part in pieces[number - 1]] if fits else [("", plain_line(raw))]
        shown.append(CodeLine(number, tuple(line), number == where.line))
    return Excerpt(where.file, tuple(shown))


def _coloured(text: str) -> list[list[Piece]]:
    """Return the pieces of each line of Python code, or an empty list if colouring would take too long."""
    return [] if len(text) > MOST_COLOURED else coloured(text)

"""The files that a notebook's cells write next to the notebook, and which text counts if a cell and its file differ.

A student hands in the package (or the answers) next to the notebook. A magic writes a cell to one of these files:

    %%node draw_circle.py    <package>/<package>/draw_circle.py
    %%package package.xml    <package>/package.xml
    %%answers                answers.toml, or <package>/answers.toml if the exercise has a package
"""

from __future__ import annotations

import posixpath
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from grader.errors import UsageError
from grader.exercise.starting_point import starting_point
from grader.submission.package import ANSWERS

if TYPE_CHECKING:
    from grader.exercise.model import Exercise

MAGICS = ("node", "package", "answers")
_FIRST_LINE = re.compile(rf"\s*%%({'|'.join(MAGICS)})\b[ \t]*(.*?)\s*")


@dataclass(frozen=True)
class Part:
    """The text that a cell writes to a file. `path` is relative to the notebook's folder."""

    path: str
    text: str


def part_path(magic: str, name: str, exercise: Exercise) -> str:
    """Return the path of the file that a cell writes, relative to the notebook's folder.

    Raises:
        UsageError: the name is not valid for such a file, or the exercise has no package and needs %%answers.
    """
    package = exercise.package
    if magic == "answers":
        return f"{package}/{ANSWERS}" if package else ANSWERS
    if not package:
        message = f"{exercise.id} has no package. Use `%%answers` to write {ANSWERS}, the file that you hand in."
        raise UsageError(message)
    if magic == "node":
        if not re.fullmatch(r"[A-Za-z_]\w*\.py", name):
            message = (
                "%%node needs the name of a Python file with only letters, digits and underscores and no digit at the "
                f"beginning, as in `%%node draw_circle.py`, not {name!r}."
            )
            raise UsageError(message)
        return f"{package}/{package}/{name}"
    if name in ("", ".") or name.startswith("/") or posixpath.normpath(name) != name or name.split("/")[0] == "..":
        message = f"%%package needs a file of the package, as in `%%package package.xml`, not {name!r}."
        raise UsageError(message)
    return f"{package}/{name}"


def parts_of(sources: list[str], exercise: Exercise) -> list[Part]:
    """Return the files that cells with these sources write. A cell with an invalid name or text writes nothing.

    If several cells write the same file, the last of these cells counts.
    """
    parts: dict[str, Part] = {}
    for source in sources:
        first, _, rest = source.partition("\n")
        match = _FIRST_LINE.fullmatch(first)
        if match is None:
            continue
        try:
            path = part_path(match[1], match[2], exercise)
            source.encode()
        except (UsageError, UnicodeEncodeError):  # JSON can contain half of a surrogate pair
            continue
        if "\0" in path:
            continue
        parts[path] = Part(path, ended(rest))
    return list(parts.values())


def ended(text: str) -> str:
    """Return the text with the line ends of Linux, and exactly one newline at its end."""
    return text.replace("\r\n", "\n").rstrip("\n") + "\n"


def counts(file: str | None, start: str | None) -> Literal["cell", "file"]:
    """Return which text counts: that of the file if the student has changed the file, or else that of the cell.

    `file` is the text of the file, and `start` is its text in the starting point. The text of a missing file is None.
    """
    if file is None or (start is not None and ended(file) == ended(start)):
        return "cell"
    return "file"


def starting_text(exercise: Exercise, path: str) -> str | None:
    """Return the text of a file in the step's starting point, or None if the starting point lacks the file."""
    file = starting_point(exercise) / path
    try:
        return file.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return None

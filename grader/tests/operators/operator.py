"""An operator adds one kind of mistake to a correct package, and defines the expected diagnoses."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.checks.diagnosis import Diagnosis


@dataclass(frozen=True)
class Package:
    """A package (contents by path), and the path of the node's file, which the operators on source code change."""

    files: Mapping[str, str]
    source: str

    @property
    def folder(self) -> str:
        """The folder that contains the Python files."""
        return self.source.rpartition("/")[0]


@dataclass(frozen=True)
class Change:
    """A package with a mistake, the file with the mistake, and the lines that a report may name (empty: any line)."""

    files: Mapping[str, str]
    file: str
    lines: frozenset[int] = frozenset()


Make = Callable[[Package, Random], Change | None]
"""Make the mistake at a random suitable place. Return None if the package has no suitable place."""


@dataclass(frozen=True)
class Operator:
    """A kind of mistake.

    `says` contains the diagnoses that name the mistake, and `never` is a pattern for false statements.

    `also` contains the diagnoses of the mistake's consequences, which are true but do not name the mistake itself.
    """

    name: str
    make: Make
    says: frozenset[Diagnosis]
    never: str = ""
    also: frozenset[Diagnosis] = frozenset()


Replacement = str | Callable[[re.Match[str]], str]


def edited(package: Package, file: str, new: str, *lines: int) -> Change:
    """Return the package with new content in one file."""
    return Change({**package.files, file: new}, file, frozenset(lines))


def line_at(text: str, place: int) -> int:
    """Return the number of the line that contains this character index, counted from 1."""
    return text.count("\n", 0, place) + 1


def replace(pattern: str, by: Replacement, *, file: str = "") -> Make:
    """Return an operator that replaces a random match of the pattern, in the source or in `file`."""

    def make(package: Package, draw: Random) -> Change | None:
        path = file or package.source
        text = package.files.get(path, "")
        found = list(re.finditer(pattern, text, re.MULTILINE))
        while found:
            match = found.pop(draw.randrange(len(found)))
            new = by(match) if callable(by) else match.expand(by)
            if new != match[0]:
                first = line_at(text, match.start() + len(match[0]) - len(match[0].lstrip("\n")))
                last = line_at(text, max(match.start(), match.end() - 1))
                return edited(package, path, text[: match.start()] + new + text[match.end() :], *range(first, last + 1))
        return None

    return make


def anywhere(make: Make) -> Make:
    """Return the same operator, except that a report may name any line of the file."""

    def made(package: Package, draw: Random) -> Change | None:
        change = make(package, draw)
        return change and Change(change.files, change.file)

    return made


def remove_line(pattern: str, *, file: str = "") -> Make:
    """Return an operator that empties a line that matches the pattern.

    In the node's file, an indented line becomes `pass`.
    """
    is_code = not file

    def make(package: Package, draw: Random) -> Change | None:
        path = file or package.source
        lines = package.files.get(path, "").split("\n")
        found = [index for index, line in enumerate(lines) if re.search(pattern, line)]
        if not found:
            return None
        index = draw.choice(found)
        line = lines[index]
        indent = line[: len(line) - len(line.lstrip())]
        lines[index] = f"{indent}pass" if is_code and indent else ""
        return edited(package, path, "\n".join(lines))

    return make


def misspelt(word: str, draw: Random) -> str:
    """Return the word with two letters swapped or one letter removed."""
    pairs = [at for at in range(1, len(word) - 1) if word[at] != word[at + 1] and word[at].isalpha()]
    if not pairs:
        return word[:-1]
    at = draw.choice(pairs)
    if draw.random() < 0.5:
        return word[:at] + word[at + 1 :]
    return word[:at] + word[at + 1] + word[at] + word[at + 2 :]

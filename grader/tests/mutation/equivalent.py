"""Mutants without an effect. equivalent.toml lists them, each with the reason."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.tests.mutation.mutants import Mutant

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FILE = Path(__file__).with_name("equivalent.toml")


@dataclass(frozen=True)
class Known:
    """A known mutant.

    `code` is a part of the line, `change` is a part of the printed change, and `why` is the reason why the mutant has
    no effect.
    """

    file: str
    code: str
    change: str
    why: str


def read(file: Path = FILE) -> tuple[Known, ...]:
    """Return the list. Raises TypeError if an entry is incomplete or has an empty reason."""
    table = tomllib.loads(file.read_text("utf-8")).get("mutant", [])
    known = tuple(Known(**entry) for entry in table)
    for each in known:
        if not each.why.strip():
            message = f"{each.file}: {each.code}: why does this change nothing?"
            raise TypeError(message)
    return known


def is_known(mutant: Mutant, known: Iterable[Known]) -> bool:
    """Return whether the mutant is on the list."""
    code = mutant.file.read_text("utf-8").splitlines()[mutant.line - 1 : mutant.end_line]
    return any(
        each.file == mutant.file.name and any(each.code in line for line in code) and each.change in mutant.change
        for each in known
    )

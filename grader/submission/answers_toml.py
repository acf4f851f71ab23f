"""Answers: the content of a student's answers.toml."""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from grader.common.words import shorten

if TYPE_CHECKING:
    from collections.abc import Mapping

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FILE = "answers.toml"
MAX_BYTES = 100_000

Answer = str | float | tuple[str, ...]


@dataclass(frozen=True)
class Answers:
    """The answers in the table [answers], by their ids: strings, numbers and lists of strings.

    `given` leaves out answers of other types, empty answers, 0, nan, and numbers that are too large. `unusable`
    contains the ids of the answers that are left out but are neither empty nor 0.

    `lines` are the line numbers of the answers, counted from 1. `problem` is the reason why the file cannot be read.
    `line` is the line of this problem, if known.
    """

    given: Mapping[str, Answer] = field(default_factory=dict)
    lines: Mapping[str, int] = field(default_factory=dict)
    unusable: frozenset[str] = frozenset()
    problem: str | None = None
    line: int | None = None


def read_answers(data: bytes) -> Answers:
    """Read an answers.toml. An error is stored in `problem` and never raised."""
    if len(data) > MAX_BYTES:
        return Answers(problem=f"it is larger than {MAX_BYTES // 1000} kB")
    try:
        text = data.decode("utf-8-sig")
        table = tomllib.loads(text).get("answers")
    except UnicodeDecodeError:
        return Answers(problem="it is not UTF-8")
    except (ValueError, RecursionError) as error:
        # Before Python 3.14, TOMLDecodeError has the line only in its text.
        line = re.search(r"\(at line (\d+)", str(error))
        if "array" in str(error) and (opened := _open_list(text)) is not None:
            return Answers(problem=f"the list on line {opened} has no ] at its end", line=opened)
        return Answers(problem=shorten(str(error), 120), line=int(line[1]) if line else None)
    if not isinstance(table, dict):
        return Answers(problem="it has no table [answers]")
    given = {key: answer for key, value in table.items() if (answer := _answer(value)) is not None}
    lines = {line.split("=")[0].strip(): number for number, line in enumerate(text.splitlines(), 1) if "=" in line}
    unusable = frozenset(key for key, value in table.items() if key not in given and not _is_empty(value))
    return Answers(given, lines, unusable)


def _answer(value: object) -> Answer | None:
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float):
        return float(value) if 0.0 < abs(value) < 1e300 else None
    if isinstance(value, str):
        return value.strip() or None
    if isinstance(value, list) and value and all(isinstance(item, str) for item in value):
        return tuple(item.strip() for item in value)
    return None


def _open_list(text: str) -> int | None:
    """Return the line of the first list without a "]" before the next answer or the end of the file, or None."""
    opened = None
    for number, line in enumerate(text.splitlines(), 1):
        begins = re.match(r"\s*\w+\s*=", line) is not None
        if begins and opened is not None:
            return opened
        if begins and "[" in line:
            opened = number
        if "]" in line:
            opened = None
    return opened


def _is_empty(value: object) -> bool:
    """Return whether the student has not given this answer yet: the starting point contains such values."""
    blank = isinstance(value, str) and not value.strip()
    return (value in ("", 0, []) and not isinstance(value, bool)) or blank

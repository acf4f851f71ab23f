"""Read a roster: a CSV file, exported from a spreadsheet, that lists the students of a class.

The separator may be a comma, a semicolon or a tab, and Excel's first line `sep=;` may name it. A byte order mark, empty
lines, spaces around values, capital letters in column names, and additional columns are all allowed.
"""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import a_list, count, line_at, shorten
from grader.errors import UsageError
from grader.exercise.own_numbers import SAME, normal_id
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path


_EXCEL = re.compile(r'"?sep=([^"\s]|\t)"?')
"""The line with which Excel marks the separator of a file."""


@dataclass(frozen=True)
class Owners:
    """The students of a class's submissions. Both mappings have the normal form of a submission's name as their key."""

    students: Mapping[str, str]
    """The student ids."""
    written: Mapping[str, str]
    """The names of the submissions as they are in the roster."""

    def remarks(self, submissions: Iterable[str]) -> Iterator[str]:
        """Yield what the roster and the names of the submissions tell about each other, for the instructor."""
        names = list(dict.fromkeys(submissions))
        normal = {normal_id(name) for name in names}
        if unlisted := [shown(name) for name in names if normal_id(name) not in self.students]:
            yield (
                f"Submissions that are not in the roster: {a_list(unlisted)}. Individual numbers, if the exercise has "
                "any, are derived from the name of the folder or archive."
            )
        if missing := [shown(name) for key, name in self.written.items() if key not in normal]:
            yield (
                f"In the roster, but not among the submissions: {a_list(missing)}. The column submission contains the "
                "names of folders, or of archives without their extensions."
            )
        by_student: dict[str, list[str]] = {}
        for name in names:
            if owner := self.students.get(normal_id(name)):
                by_student.setdefault(normal_id(owner), []).append(shown(name))
        for same in by_student.values():
            if len(same) > 1:
                yield f"In the roster, {a_list(same)} belong to the same student. Each of them has its own result."


def read_owners(file: Path) -> Owners:
    """Return the students of the submissions. Raises UsageError, as `read_roster` does."""
    rows = read_roster(file, ("submission", "student")).values()
    names = {normal_id(row["submission"]): row for row in rows}
    return Owners(
        {key: row["student"] for key, row in names.items()}, {key: row["submission"] for key, row in names.items()}
    )


def read_roster(file: Path, needed: Sequence[str], also: Sequence[str] = ()) -> dict[int, dict[str, str]]:
    """Return a mapping from each line number to the values of that line by column.

    The values of the columns in `needed` are never empty, and the values of the first of these columns are unique, even
    in their normal form.

    Raises:
        UsageError: the file is not a roster. If a single line is wrong, the message contains its number.
    """
    separator, read = _lines(file)
    (_, names), *lines = read or [(1, [])]
    columns = [name.lower() for name in names]
    if any(columns.count(name) != 1 for name in needed):
        wanted = "the column " if len(needed) == 1 else "each of the columns "
        wanted += a_list([f'"{name}"' for name in needed]) + " once"
        wanted += f", and perhaps {a_list(also)}" if also else ""
        header = shorten(separator.join(names))
        message = f'{file} is not a roster: its first line must name {wanted}, but it is "{header}".'
        raise UsageError(message)
    if not lines:
        message = f"{file} is not a roster: it contains only the column names."
        raise UsageError(message)
    rows: dict[int, dict[str, str]] = {}
    lines_of: dict[str, int] = {}
    """The line number of each name. The names are in their normal form."""
    for line, values in lines:
        given = dict(zip(columns, values, strict=False))
        rows[line] = {name: given.get(name, "") for name in (*needed, *also)}
        empty = [name for name in needed if not rows[line][name]]
        name = rows[line][needed[0]]
        if any(values[len(columns) :]):
            fault = f"{len(values)} values for {count(len(columns), 'column')}."
            fault += " Put a value in quotes if it contains a separator."
        elif empty:
            fault = f"the {empty[0]} is missing."
        elif (first := lines_of.setdefault(normal_id(name), line)) != line:
            other = rows[first][needed[0]]
            fault = f'the {needed[0]} "{shorten(name)}" is already on line {first}'
            fault += "." if other == name else f', as "{shorten(other)}": {SAME}.'
        else:
            continue
        message = f"{file}, line {line}: {fault}"
        raise UsageError(message)
    return rows


def _lines(file: Path) -> tuple[str, list[tuple[int, list[str]]]]:
    """Return the separator, and the values of each line that is not empty, together with the line number.

    Raises UsageError if the file cannot be read, is not UTF-8 or is not CSV.
    """
    try:
        data = file.read_bytes()
        text = data.decode("utf-8-sig")
        first = next(iter(text.split("\n", 1)[0].splitlines()), "")
        if excel := _EXCEL.fullmatch(first):
            separator, text = excel[1], text[len(first) :]  # the line stays, so that the numbers of lines are right
        else:
            header = text.lstrip().partition("\n")[0]
            separator = max(",;\t", key=header.count)
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
        lines = [(reader.line_num, [value.strip() for value in values]) for values in reader]
    except OSError as error:
        message = f"{file} cannot be read: {error.strerror}."
        raise UsageError(message) from error
    except UnicodeDecodeError as error:
        line = line_at(error.object, error.start)
        message = f'{file}, line {line}: this is not UTF-8. Save the file as "CSV UTF-8" in your spreadsheet.'
        raise UsageError(message) from error
    except csv.Error as error:
        message = f"{file}, line {reader.line_num}: this is not CSV: {error}."
        raise UsageError(message) from error
    return separator, [(number, values) for number, values in lines if any(values)]

"""Read a roster: a CSV file, exported from a spreadsheet, that lists the students of a class.

The separator may be a comma or a semicolon. A byte order mark, empty lines, spaces around values, capital letters in
column names, and additional columns are all allowed.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

from grader.common.words import a_list, count, shorten
from grader.errors import UsageError
from grader.exercise.own_numbers import SAME, normal_id

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def read_owners(file: Path) -> dict[str, str]:
    """Return a mapping from the names of submissions to student ids. Raises UsageError, as `read_roster` does.

    The names are in their normal form (grader.exercise.own_numbers.normal_id).
    """
    rows = read_roster(file, ("submission", "student")).values()
    return {normal_id(row["submission"]): row["student"] for row in rows}


def read_roster(file: Path, needed: Sequence[str], also: Sequence[str] = ()) -> dict[int, dict[str, str]]:
    """Return a mapping from each line number to the values of that line by column.

    The values of the columns in `needed` are never empty, and the values of the first of these columns are unique, even
    in their normal form.

    Raises:
        UsageError: the file is not a roster. If a single line is wrong, the message contains its number.
    """
    (_, names), *lines = _lines(file) or [(1, [])]
    columns = [name.lower() for name in names]
    if any(columns.count(name) != 1 for name in needed):
        wanted = "the column " if len(needed) == 1 else "each of the columns "
        wanted += a_list([f'"{name}"' for name in needed]) + " once"
        wanted += f", and perhaps {a_list(also)}" if also else ""
        header = shorten(",".join(names))
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


def _lines(file: Path) -> list[tuple[int, list[str]]]:
    """Return the values of each line that is not empty, together with the line number.

    Raises UsageError if the file cannot be read, is not UTF-8 or is not CSV.
    """
    try:
        data = file.read_bytes()
        text = data.decode("utf-8-sig")
        first = text.lstrip().partition("\n")[0]
        separator = ";" if first.count(";") > first.count(",") else ","
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
        lines = [(reader.line_num, [value.strip() for value in values]) for values in reader]
    except OSError as error:
        message = f"{file} cannot be read: {error.strerror}."
        raise UsageError(message) from error
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        message = f'{file}, line {line}: this is not UTF-8. Save the file as "CSV UTF-8" in your spreadsheet.'
        raise UsageError(message) from error
    except csv.Error as error:
        message = f"{file}, line {reader.line_num}: this is not CSV: {error}."
        raise UsageError(message) from error
    return [(number, values) for number, values in lines if any(values)]

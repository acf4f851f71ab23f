"""A class as a CSV table, with hostile text in its cells."""

from __future__ import annotations

import csv
import io
import unicodedata

import pytest

from grader.report.csv import COLUMNS, to_csv
from grader.tests.report.readers import table
from grader.tests.report.reports import STATUSES, hostile_report, report


def test_the_table_has_one_line_per_submission() -> None:
    found = table(*((status, report(status)) for status in STATUSES))
    assert [row["submission"] for row in found] == list(STATUSES)
    assert [row["status"] for row in found] == ["passed", "failed", "failed", "error"]
    assert all(set(row) == set(COLUMNS) for row in found)
    assert float(found[0]["points"]) == report("passed").points
    assert "circle" in found[1]["failed"].split()
    assert "wrong-radius" in found[1]["diagnoses"].split()


SIGNS = ("=", "+", "-", "@", "＝", "＋", "－", "＠", "﹣", "\N{MINUS SIGN}")  # noqa: RUF001 - the attack uses them
BEFORE = (
    "",
    " ",
    "\t",
    "\r",
    "\n",
    "\r\n",
    "\N{NO-BREAK SPACE}",
    "\N{IDEOGRAPHIC SPACE}",
    '"',
    "' ",
    "\ufeff",
    "\v",
    "\0",
)
SEPARATORS = (",", ";", "\t", "|")


def begins_like_a_formula(cell: str) -> bool:
    """Return whether a spreadsheet might run the cell as a formula, even if the cell begins with spaces or quotes."""
    return unicodedata.normalize("NFKC", cell).lstrip(' \t\r\n"`').startswith(("=", "+", "-", "@", "\N{MINUS SIGN}"))


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("separator", SEPARATORS)
def test_no_cell_is_a_formula_with_any_separator(sign: str, separator: str) -> None:
    call = f"{sign}cmd|' /C calc'!A0"
    names = [f"{before}{call}" for before in BEFORE]
    names += [f"a{between}{before}{call}{between}b" for between in ";|\t" for before in BEFORE]
    text = to_csv((name, hostile_report(), "0.1.0 abc", f"{name}.json", name) for name in names).removeprefix("\ufeff")
    rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=separator))
    rows += [line.split(separator) for line in text.split("\r\n")]  # a reader that does not support quotes
    cells = [cell for row in rows for cell in row]
    assert len(cells) > len(names)
    assert [cell for cell in cells if begins_like_a_formula(cell)] == []
    assert all(cell.isprintable() for cell in text.split("\r\n"))

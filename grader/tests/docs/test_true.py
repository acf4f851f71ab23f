"""The tables in docs/ agree with the code: limits of cells, keys of exercise.toml."""

from __future__ import annotations

import re

import pytest

from grader.checks.kinds import KINDS
from grader.colcon import runner
from grader.errors import UsageError
from grader.exercise.exercise_toml import SCHEMA, parse_exercise
from grader.gradebook import relay
from grader.gradebook.budget import Budget
from grader.sandbox.limits import MIB, MOST_SIGNALS, NODE_LIMITS, Limits
from grader.sandbox.user import FEW_USERS, FIRST_USER, USERS
from grader.submission import answers_toml, bag_folder, code, constants, package_xml, reader, tree
from grader.tests.docs.pages import ROOT, text_of
from grader.trial.conductor import MESSAGES_HZ, REQUESTS_HZ

SANDBOX = "docs/sandbox.md"
"""The page with the limits of all processes."""
COLUMNS = (runner.LIMITS, NODE_LIMITS, Limits())
"""The limits for the build, the node and the kernel, in the order of the table's columns."""
KEYS = {
    "[exercise]": '[exercise]\nwrong = 1\npackage = "p"\n',
    "[[trial]]": '[exercise]\npackage = "p"\n[[trial]]\nwrong = 1\n',
    "[[trial.drive]]": "[[trial]]\n[[trial.drive]]\nwrong = 1\n",
    "[[check]]": '[[check]]\nkind = "builds"\nwrong = 1\n',
    "[[hint]]": "[[hint]]\nwrong = 1\n",
}
"""Maps a table to a file with an unknown key in the table. The error message lists the valid keys."""

TABLES = {"call", "drive", "parameters", "params_file", "set"}
"""Keys that are tables themselves."""
OPTIONAL = {"[[trial]]": {"alone_s", "beside"}}
"""Maps a table to keys that are valid only in some of these tables, so that the error message does not list them."""


def row(words: str) -> list[str]:
    line = next(line for line in text_of(SANDBOX).splitlines() if line.startswith(f"| {words} |"))
    return [cell.strip() for cell in line.strip("|").split("|")[1:]]


@pytest.mark.parametrize(
    ("words", "name", "unit"),
    [
        ("processes and threads", "processes", ""),
        ("address space per process", "memory", "MiB"),
        ("memory of all processes and disks together", "total_memory", "MiB"),
        ("each writable disk", "disk", "MiB"),
        ("files on all writable disks", "files", ""),
        ("size of a file", "file_size", "MiB"),
        ("open files per process", "open_files", ""),
        ("CPU time per process", "cpu_s", "s"),
    ],
)
def test_the_limits_of_a_cell_are_those_of_the_code(words: str, name: str, unit: str) -> None:
    values = [getattr(limits, name) // (MIB if unit == "MiB" else 1) for limits in COLUMNS]
    assert row(words) == [f"{value} {unit}".strip() for value in values]


def test_every_limit_of_a_cell_is_in_the_table() -> None:
    table = text_of(SANDBOX).split("| limit | build | node | kernel |", 1)[1].split("\n\n", 1)[0]
    assert len(table.strip().splitlines()) - 1 == len(Limits.__dataclass_fields__)


def test_the_budgets_of_reading_are_those_of_the_code() -> None:
    text = " ".join(text_of(SANDBOX).split())
    reported = f"{code.MAX_BYTES // 1000} kB per Python file and {code.MOST_BYTES // 1_000_000} MB in total"
    assert reported in text
    answers, manifest = (f"{one.MAX_BYTES // 1000} kB" for one in (answers_toml, package_xml))
    assert f"{manifest} for package.xml, {answers} for answers.toml" in text
    chunk = f"{bag_folder.MOST_CHUNK_BYTES // MIB} MiB per chunk of a bag"
    assert f"{constants.MAX_NODES:,} syntax nodes per Python module are evaluated" in text
    assert f"{bag_folder.MOST_MESSAGES:,} messages and {chunk}" in text
    assert (
        f"{tree.MAX_FILES:,} files, {tree.MAX_FILE_BYTES // MIB} MiB per file and {tree.MAX_TOTAL_BYTES // MIB} MiB"
        in text
    )


def test_the_limits_of_the_processes_of_the_grader_are_those_of_the_code() -> None:
    text, budget = " ".join(text_of(SANDBOX).split()), Budget()
    one, total = budget.message // MIB, budget.total // MIB
    assert (
        f"{budget.messages:,} messages from its kernel, {one} MiB each, {total} MiB and a million JSON values in total"
        in text
    )
    assert budget.values == 1_000_000
    assert f"{relay.MOST_MEMORY // MIB // 1024} GiB of address space; {budget.messages:,} messages" in text
    read_s, memory, answer = reader.TIMEOUT_S, reader.MEMORY // MIB // 1024, reader.MOST_ANSWER // MIB
    times, size = f"{reader.CPU_S} s of CPU time, {read_s:g} s of wall time", f"{memory} GiB of address space"
    assert f"{times}, {size} in addition to the grader's, {answer} MiB of output" in text
    assert f"at most {MOST_SIGNALS} per cell" in text
    security = " ".join(text_of("docs/security.md").split())
    assert f"{REQUESTS_HZ} requests or {MESSAGES_HZ} messages per second" in security


def test_the_users_of_the_cells_are_named() -> None:
    text = " ".join(text_of(SANDBOX).split())
    assert f"{FIRST_USER} to {FIRST_USER + USERS - 1}" in text
    assert f"{FEW_USERS[0]} to {FEW_USERS[-1]}" in text


@pytest.mark.parametrize("table", KEYS)
def test_the_authors_page_lists_every_key(table: str) -> None:
    with pytest.raises(UsageError) as refused:
        parse_exercise(f"schema = {SCHEMA}\n{KEYS[table]}".encode(), "exercise.toml", ROOT, KINDS)
    line = next(line for line in str(refused.value).splitlines() if 'unknown key "wrong"' in line)
    allowed = set(line.partition("Allowed: ")[2].rstrip(".").split(", "))
    assert keys_of(table) == allowed - TABLES | OPTIONAL.get(table, set())


def keys_of(table: str) -> set[str]:
    """Return the keys that the page lists for a table of exercise.toml."""
    rows = text_of("docs/authors.md").split("| table | key | meaning |", 1)[1].split("\n\n", 1)[0].splitlines()[2:]
    here, keys = "", set()
    for cells in ([cell.strip() for cell in line.strip().strip("|").split("|")] for line in rows):
        here = cells[0].strip("`") or here
        if here == table:
            keys |= set(re.findall(r"`(\w+)`", cells[1]))
    return keys

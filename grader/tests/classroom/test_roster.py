from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.classroom.found import Found
from grader.classroom.order import Order, sources_for
from grader.classroom.roster import read_owners, read_roster
from grader.errors import UsageError
from grader.tests.classroom.a_class import STEP, grade

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "roster.csv"


@pytest.mark.parametrize(
    "text",
    [
        "submission,student\nteam 1,ada\nteam 2,bob\n",
        "\ufeffsubmission,student\nteam 1,ada\nteam 2,bob\n",
        "\r\nsubmission;student\r\nteam 1;ada\r\nteam 2;bob\r\n",
        "sep=;\r\nsubmission;student\r\nteam 1;ada\r\nteam 2;bob\r\n",
        '"sep=\t"\nsubmission\tstudent\nteam 1\tada\nteam 2\tbob\n',
        "submission\tstudent\nteam 1\tada\nteam 2\tbob\n",
        '\n Student , Room,SUBMISSION\n"ada","1, left",  team 1\n\n,,\nbob,2,team 2,,\n',
    ],
    ids=[
        "plain",
        "byte order mark",
        "semicolons",
        "Excel",
        "Excel with tabs",
        "tabs",
        "spaces, capitals, quotes and other columns",
    ],
)
def test_rosters_of_common_spreadsheets_are_read(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8", newline="")
    assert read_owners(file).students == {"team 1": "ada", "team 2": "bob"}


def test_line_numbers_are_those_of_the_file_and_missing_columns_are_empty(file: Path) -> None:
    file.write_text('id,room,email\n\n"ada",1,a@b\nbob\n')
    assert read_roster(file, ["id"], ["name", "email"]) == {
        3: {"id": "ada", "name": "", "email": "a@b"},
        4: {"id": "bob", "name": "", "email": ""},
    }


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", 'the column "id" once, and perhaps name and email, but it is "".'),
        (b"ada,Ada\nbob,Bob\n", 'but it is "ada,Ada".'),
        (b"ident;name\nada;Ada\n", 'but it is "ident;name".'),
        (b"sep=;\nident;name\nada;Ada\n", 'but it is "ident;name".'),
        (b"sep=;\nid;name\n;Ada\n", "line 3: the id is missing"),
        # Python 3.13 refuses a quotation mark as a separator with another exception.
        (b'sep="\nid;name\nada;Ada\n', 'but it is "sep='),
        (b"id,name,id\nada,Ada,a1\n", 'but it is "id,name,id".'),
        (b"id,name\n\n", "it contains only the column names"),
        (b"id,name\nada,Lovelace, Ada\n", "line 2: 3 values for 2 columns"),
        (b"id\nada,Ada\n", "line 2: 2 values for 1 column. Put"),
        (b"id,name\n\n,Ada\n", "line 3: the id is missing"),
        (b"id\nada\n\nbob\nada\n", 'line 5: the id "ada" is already on line 2'),
        (b"id\nada\nAda\n", 'line 3: the id "Ada" is already on line 2, as "ada": capital letters'),
        ("id\nzo\u00eb\nzoe\u0308\n".encode(), "is already on line 2"),
        (b"id,name\nada,M\xfcller\n", "line 2: this is not UTF-8"),
        ("id,name\nada,Ada\n".encode("utf-16"), "line 1: this is not UTF-8"),
        (b'id,name\nada,Ada\nbob,"Bob\neve,Eve\n', "this is not CSV: unexpected end of data"),
    ],
)
def test_a_file_that_is_not_a_roster_is_a_usage_error(file: Path, data: bytes, why: str) -> None:
    file.write_bytes(data)
    with pytest.raises(UsageError) as reported:
        read_roster(file, ["id"], ["name", "email"])
    assert why in str(reported.value)
    assert str(reported.value).startswith(str(file))


def test_a_file_that_cannot_be_read_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read: Is a directory"):
        read_owners(tmp_path)


def test_a_submission_finds_its_student_in_any_spelling(file: Path, tmp_path: Path) -> None:
    file.write_text("submission,student\nTeam Zo\u00eb,ada\n", encoding="utf-8")
    found = Found("team zoe\u0308", STEP, tmp_path)
    order = Order(found=(found,), roster=read_owners(file).students, sources=sources_for((found,), None), ros="none")
    assert order.task(found).owner == "ada"


def test_a_name_that_is_not_in_the_roster_changes_no_terminal(tmp_path: Path, file: Path) -> None:
    (tmp_path / "class" / "eve\x1b]0;owned\x07\u202e").mkdir(parents=True)
    file.write_text("submission,student\nann,ann\n")
    for name in ("ben.ipynb", "notes.txt"):
        (tmp_path / "class" / name).touch()
    done = grade(tmp_path / "class", "--exercise", STEP, "--out", tmp_path / "out", "--roster", file)
    (line,) = [line for line in (done.stdout + done.stderr).splitlines() if "not in the roster" in line]
    assert "eve" in line
    assert "Ignored: ben.ipynb and notes.txt are not submissions. To grade ben.ipynb, put it into" in done.stdout
    assert all(char.isprintable() for char in line)


def test_remarks_compare_the_roster_with_the_submissions(file: Path) -> None:
    file.write_text("submission,student\nTeam 1,ada\nteam1_old,Ada\nTeam 2.zip,bob\n")
    unlisted, missing, same = read_owners(file).remarks(["team 1", "team1_old", "Team 2"])
    assert unlisted.startswith("Submissions that are not in the roster: Team 2. ")
    assert missing.startswith("In the roster, but not among the submissions: Team 2.zip. ")
    assert same == "In the roster, team 1 and team1_old belong to the same student. Each of them has its own result."


def test_a_complete_roster_needs_no_remark(file: Path) -> None:
    file.write_text("submission,student\nteam 1,ada\nteam 2,bob\n")
    assert not list(read_owners(file).remarks(["team 2", "Team 1", "Team 1"]))

"""Words of a command line with typographic dashes and quotation marks, and paths without quotes."""

# ruff: noqa: RUF001 - these are the characters to find

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import pytest
from typer.testing import CliRunner

from grader.cli import app
from grader.common import typing_slips
from grader.common.typing_slips import hint, slip
from grader.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path


def error(*words: str) -> str:
    found = CliRunner().invoke(app, words).exception
    assert isinstance(found, UsageError)
    return str(found)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make an empty folder the current folder and the home folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize(
    ("words", "right"),
    [
        (["check", "–html", "x.html"], "grader check --html x.html"),
        (["check", "—html=x.html", "mine"], "grader check --html=x.html mine"),
        (["check", "−v"], "grader check -v"),
        (["check", "-–seed", "7"], "grader check --seed 7"),
        (["check", "–help"], "grader check --help"),
        (["sim", "–view"], "grader sim --view"),
        (["run", "07", "—no-view"], "grader run 07 --no-view"),
        (["—help"], "grader --help"),
        (["gradebook", "–h"], "grader gradebook -h"),
    ],
)
def test_a_typographic_dash_names_the_line_with_minus_signs(words: list[str], right: str) -> None:
    assert "typographic dash" in error(*words)
    assert error(*words).endswith(f"Type: {right}")


@pytest.mark.parametrize("word", ["–mine", "mine–html", "-html", "--html", "–", ""])
def test_other_words_have_no_typographic_dash(word: str) -> None:
    assert slip("grader check", [word], ["--html", "-v"]) == ""


def test_a_folder_whose_name_begins_with_a_dash_is_a_folder(folder: Path) -> None:
    (folder / "–html").mkdir()
    assert slip("grader check", ["–html"], ["--html"]) == ""


@pytest.mark.parametrize(
    ("typed", "right"),
    [
        ("“mine”", ["mine"]),
        ("„Mein Kürs“ --exercise ‚03‘", ["Mein Kürs", "--exercise", "03"]),
        ("”my ws/src”", ["my ws/src"]),
        ("“~/my ws”", ["{home}/my ws"]),
        ("“~nobody-of-this-name/my ws”", ["~nobody-of-this-name/my ws"]),
    ],
)
def test_typographic_quotation_marks_name_the_line_with_straight_ones(
    typed: str, right: list[str], folder: Path
) -> None:
    said = slip("grader check", shlex.split(typed), [])
    assert "quotation marks are typographic" in said
    line = said.partition("Type: ")[2]
    assert shlex.split(line) == ["grader", "check", *(word.format(home=folder) for word in right)]


@pytest.mark.parametrize("typed", ["it’s", "“mine", "mine”", "”", "“”", ""])
def test_a_single_quotation_mark_may_belong_to_a_name(typed: str) -> None:
    assert slip("grader check", [typed], []) == ""


@pytest.mark.parametrize("also", [False, True], ids=["alone", "beside a folder with the first word as its name"])
def test_a_path_without_quotes_names_the_line_with_quotes(folder: Path, also: bool) -> None:
    (folder / "my old ws").mkdir()
    if also:
        (folder / "my").mkdir()
    assert error("check", "my", "old", "ws", "--seed", "3").endswith("Type: grader check 'my old ws' --seed 3")
    assert slip("grader grade", ["my", "old"], []) == ""


def test_two_paths_that_both_exist_are_two_paths(folder: Path) -> None:
    for name in ("a", "b", "a b"):
        (folder / name).mkdir()
    assert slip("grader grade", ["a", "b"], []) == ""


def test_many_paths_and_long_ones_take_no_time(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def ask(path: str) -> bool:
        asked.append(path)
        return False

    monkeypatch.setattr(typing_slips, "_exists", ask)
    assert slip("grader grade", [f"student-{number}" for number in range(2000)], []) == ""
    assert len(asked) < 30_000
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    assert slip("grader grade", ["x" * 5000, "y" * 5000], []) == ""


def test_a_word_too_many_names_the_words_that_the_command_takes() -> None:
    said = error("check", "3", "4")
    assert said.startswith("4 is more than `grader check` takes. Expected: grader check [OPTIONS] ")
    assert said.endswith("grader check --help")
    assert error("status", "3").startswith("3 is more than `grader status` takes.")


@pytest.mark.parametrize(
    "line",
    ["topic list -t", "topic echo /a --once", "pub '{x: 1}' '{y: 2}'", "pub '– hello'", "a {}", "{ a", "“a b", "it’s"],
)
def test_after_other_errors_there_is_no_hint(line: str) -> None:
    assert hint(shlex.split(line)) == ""

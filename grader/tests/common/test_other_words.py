from __future__ import annotations

import re

import pytest
import typer.main
from typer.testing import CliRunner

from grader.cli import app
from grader.common import other_words
from grader.errors import UsageError


def error(*words: str) -> str:
    found = CliRunner().invoke(app, words).exception
    assert isinstance(found, UsageError)
    return str(found)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("next", "grader start next"),
        ("begin", "grader start"),
        ("test", "grader check"),
        ("build", "grader run"),
        ("lesson", "grader open"),
        ("turtlesim", "grader sim --view"),
        ("help", "grader --help"),
    ],
)
def test_a_word_that_means_a_command_names_it(typed: str, meant: str) -> None:
    assert error(typed, "03") == f"There is no command {typed}. Type: {meant}"


def test_the_suggested_commands_exist_and_the_other_words_are_not_commands() -> None:
    known = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    for command, words in other_words._MEANT.items():
        assert command == "make demo" or re.match(r"grader (\w+|--help)", command)[1] in {*known, "--help"}  # type: ignore[index]
        assert not set(words.split()) & set(known)


def test_other_words_get_the_most_similar_commands() -> None:
    assert "Did you mean 'check'?" in CliRunner().invoke(app, ["chekc"]).output
    assert "No such command 'next'" in CliRunner().invoke(app, ["gradebook", "next"]).output


@pytest.mark.parametrize("words", [("03", "mine"), ("mine", "03")])
@pytest.mark.parametrize("command", ["check", "watch"])
def test_a_step_and_a_package_name_the_option_for_the_step(command: str, words: tuple[str, str]) -> None:
    assert error(command, *words).endswith(f"Name its step with an option: grader {command} mine --exercise 03")


@pytest.mark.parametrize("words", [("mine", "yours"), ("03", "04"), ("03",), ("--seed", "3")])
def test_other_words_name_no_option(words: tuple[str, ...]) -> None:
    assert other_words.with_exercise("grader check", words) == ""


def test_a_suggested_command_can_be_typed_as_it_stands_even_with_spaces_in_the_path() -> None:
    assert other_words.with_exercise("grader check", ["03", "my work"]) == "grader check 'my work' --exercise 03"

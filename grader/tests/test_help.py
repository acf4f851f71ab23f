"""The help texts of the command `grader`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import typer.main
from typer.testing import CliRunner

from grader.cli import app

if TYPE_CHECKING:
    from collections.abc import Iterator


def commands(command: Any) -> Iterator[Any]:  # noqa: ANN401 - click's Command, which typer brings itself
    yield command
    for each in getattr(command, "commands", {}).values():
        yield from commands(each)


def walk(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:  # noqa: ANN401 - as above
    """Yield the words of each command and group, and the command."""
    yield path, command
    for name, each in getattr(command, "commands", {}).items():
        yield from walk(each, (*path, name))


def every_help(monkeypatch: pytest.MonkeyPatch, width: int) -> Iterator[tuple[Any, str]]:
    """Yield each command and its help on a terminal with this number of columns."""
    monkeypatch.setenv("COLUMNS", str(width))
    for words, command in walk(typer.main.get_command(app)):
        yield command, CliRunner().invoke(app, [*words, "--help"]).output


def test_on_a_terminal_of_80_columns_no_help_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    found = list(every_help(monkeypatch, 80))
    assert len(found) > 20
    for command, shown in found:
        assert "--help" in shown
        assert "…" not in shown
        examples = (command.epilog or "").partition(": ")[2].split("; ")
        assert [each for each in examples if each not in shown] == []


@pytest.mark.parametrize("width", [40, 60])
def test_on_a_narrow_terminal_no_help_is_cut_and_no_word_is_broken(monkeypatch: pytest.MonkeyPatch, width: int) -> None:
    for command, shown in every_help(monkeypatch, width):
        assert [line for line in shown.splitlines() if len(line) > width] == []
        # Without the lines that end an example, the words are those of the wide help, and none is broken.
        words = set(shown.replace("\\\n", "").split())
        texts = [command.help or "", *(getattr(param, "help", "") or "" for param in command.params)]
        texts += [each.help or "" for each in getattr(command, "commands", {}).values()]
        texts += [(command.epilog or "").partition(": ")[2].replace("; ", " ")]
        texts += [option for param in command.params for option in param.opts if option.startswith("-")]
        assert {word for text in texts for word in text.split()} - words - {f"{option}," for option in words} <= {
            word.removesuffix(",") for word in words
        }


def test_no_help_text_has_brackets_which_rich_would_remove() -> None:
    found = list(commands(typer.main.get_command(app)))
    texts = [each.help or "" for each in found]
    texts += [getattr(param, "help", None) or "" for each in found for param in each.params]
    assert len(texts) > 60
    assert [text for text in texts if "[" in text] == []

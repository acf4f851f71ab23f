"""The help texts of the command `grader`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer.main
from typer.testing import CliRunner

from grader.cli import app

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pytest


def commands(command: Any) -> Iterator[Any]:  # noqa: ANN401 - click's Command, which typer brings itself
    yield command
    for each in getattr(command, "commands", {}).values():
        yield from commands(each)


def endings(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:  # noqa: ANN401 - as above
    """Yield the words of each command without subcommands."""
    below = getattr(command, "commands", {})
    if not below:
        yield path
    for name, each in below.items():
        yield from endings(each, (*path, name))


def test_on_a_terminal_of_80_columns_no_help_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    cut = {}
    found = list(endings(typer.main.get_command(app)))
    assert len(found) > 20
    for words in found:
        shown = CliRunner().invoke(app, [*words, "--help"]).output
        assert "--help" in shown
        cut[words] = [line for line in shown.splitlines() if "…" in line]
    assert {words: lines for words, lines in cut.items() if lines} == {}


def test_no_help_text_has_brackets_which_rich_would_remove() -> None:
    found = list(commands(typer.main.get_command(app)))
    texts = [each.help or "" for each in found]
    texts += [getattr(param, "help", None) or "" for each in found for param in each.params]
    assert len(texts) > 60
    assert [text for text in texts if "[" in text] == []

"""The help texts of the command `grader`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer.main

from grader.cli import app

if TYPE_CHECKING:
    from collections.abc import Iterator


def commands(command: Any) -> Iterator[Any]:  # noqa: ANN401 - click's Command, which typer brings itself
    yield command
    for each in getattr(command, "commands", {}).values():
        yield from commands(each)


def test_no_help_text_has_brackets_which_rich_would_remove() -> None:
    found = list(commands(typer.main.get_command(app)))
    texts = [each.help or "" for each in found]
    texts += [getattr(param, "help", None) or "" for each in found for param in each.params]
    assert len(texts) > 60
    assert [text for text in texts if "[" in text] == []

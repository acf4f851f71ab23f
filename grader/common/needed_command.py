"""Leave out the commands of a typer application that are not on the command line."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING

from typer.main import get_command_name, get_group

if TYPE_CHECKING:
    from collections.abc import Sequence

    import typer
    from typer.core import TyperGroup
    from typer.models import CommandInfo


def needed_command(app: typer.Typer, words: Sequence[str]) -> TyperGroup:
    """Return the application with only the command that is given in `words`, or the whole application if there is none.

    To create a command, typer evaluates the annotations of all its options. Evaluating the annotations of all commands
    would take longer than running most commands.
    """
    word = next((word for word in words if not word.startswith("-")), "")
    named = [command for command in app.registered_commands if _name(command) == word]
    if named:
        app = copy(app)
        app.registered_commands, app.registered_groups = named, []
    return get_group(app)


def _name(command: CommandInfo) -> str:
    return command.name or get_command_name(getattr(command.callback, "__name__", ""))

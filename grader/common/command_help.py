"""The help of the command `grader`, and its error messages for words that are not commands.

On narrow terminals, the help is printed in one column, without typer's tables. On a terminal that is 40 characters
wide, a table with four columns would leave only 8 characters for the text.
"""

from __future__ import annotations

import importlib
import shutil
import sys
import textwrap
from contextlib import contextmanager
from types import ModuleType
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperArgument, TyperCommand, TyperGroup

from grader.common.other_words import command_for, with_exercise
from grader.common.terminal_text import example
from grader.common.typing_slips import slip
from grader.common.words import printable
from grader.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator

HELP = ("--help", "-h")
WIDE = 80
"""The number of columns that typer's tables need."""


class Command(TyperCommand):
    """A command whose help fits every terminal."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:  # noqa: ANN401 - typer brings its own click
        """Parse the arguments.

        Raises UsageError if they are a package and a step, without --exercise, if there are too many, or if their
        dashes or quotation marks are not those of a keyboard.
        """
        words = list(args)
        if ctx.resilient_parsing:  # the shell requests completions
            return super().parse_args(ctx, args)
        wrong = slip(ctx.command_path, words, [*(name for param in self.params for name in _names(param)), *HELP])
        if wrong:
            raise UsageError(wrong)
        if len(words) == 2 and any("--exercise" in param.opts for param in self.params):
            meant = with_exercise(ctx.command_path, words)
            if meant:
                message = f"`{ctx.command_path}` takes one package. Name its step with an option: {meant}"
                raise UsageError(message)
        if ctx.allow_extra_args:
            flags = {name for param in self.params if getattr(param, "is_flag", False) for name in _names(param)}
            args = [part for word in args for part in _with_separate_value(word, flags)]
        refuses, ctx.allow_extra_args = not ctx.allow_extra_args, True
        rest = super().parse_args(ctx, args)
        if rest and refuses:
            usage = " ".join(self.collect_usage_pieces(ctx))
            message = (
                f"{printable(' '.join(rest))} is more than `{ctx.command_path}` takes. Expected: {ctx.command_path} "
                f"{usage}. More about it: {ctx.command_path} --help"
            )
            raise UsageError(message)
        return rest

    def format_help(self, ctx: Any, formatter: Any) -> None:  # noqa: ANN401 - typer brings its own click
        """Print the help of the command."""
        _format_help(self, super().format_help, ctx, formatter)


class Group(TyperGroup):
    """A group of commands whose help fits every terminal."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:  # noqa: ANN401 - as above
        """Find the command. Raises UsageError for a word that users type when they mean another command."""
        wrong = slip(ctx.command_path, args, HELP)
        if wrong:
            raise UsageError(wrong)
        meant = command_for(args[0]) if ctx.parent is None and args[0] not in self.commands else ""
        if meant:
            message = f"There is no command {printable(args[0])}. Type: {meant}"
            raise UsageError(message)
        return super().resolve_command(ctx, args)

    def format_help(self, ctx: Any, formatter: Any) -> None:  # noqa: ANN401 - as above
        """Print the help of the group."""
        _format_help(self, super().format_help, ctx, formatter)


class App(typer.Typer):
    """A typer application whose help fits every terminal."""

    def __init__(self, **options: Any) -> None:  # noqa: ANN401 - typer's options
        super().__init__(cls=Group, **options)

    def command(self, name: str | None = None, **options: Any) -> Callable[[Any], Any]:  # noqa: ANN401 - as above
        """Return a decorator that adds a command to the application."""
        return super().command(name, cls=Command, **options)


def _with_separate_value(word: str, flags: Collection[str]) -> tuple[str, ...]:
    """Separate `--view=terminal` into two words, since typer's flags do not take a value."""
    name, equals, value = word.partition("=")
    return (name, value) if equals and name in flags else (word,)


def _names(param: Any) -> list[str]:  # noqa: ANN401 - typer brings its own click
    return [] if isinstance(param, TyperArgument) else [*param.opts, *param.secondary_opts]


def _format_help(
    command: TyperCommand | TyperGroup,
    wide: Callable[[Any, Any], None],
    context: Any,  # noqa: ANN401 - as above
    formatter: Any,  # noqa: ANN401 - as above
) -> None:
    width = shutil.get_terminal_size().columns
    if width >= WIDE:
        with _without("rich.markdown", "Markdown"), _without("rich.traceback", "Traceback"):
            importlib.import_module("typer.rich_utils")
        wide(context, formatter)
    else:
        formatter.write("\n".join(_narrow(command, context, width)))


@contextmanager
def _without(module: str, name: str) -> Iterator[None]:
    """Replace a module with a stand-in that has only the attribute `name`, unless the module is already imported.

    typer imports this name, but does not need it to print a help text. Importing the real module takes longer than
    printing the text.
    """
    if module in sys.modules:
        yield
        return
    sys.modules[module] = stand_in = ModuleType(module)
    setattr(stand_in, name, None)
    try:
        yield
    finally:
        del sys.modules[module]


def _narrow(command: TyperCommand | TyperGroup, context: Any, width: int) -> Iterator[str]:  # noqa: ANN401 - as above
    """Yield the lines of the help: usage, description, one section per panel, and examples."""
    usage = f"Usage: {context.command_path} {' '.join(command.collect_usage_pieces(context))}"
    yield from _wrapped(usage, width, "", "    ")
    yield ""
    yield from _wrapped(command.help or "", width)
    for title, entries in _sections(command, context).items():
        yield from ("", f"{title}:")
        for name, text in entries:
            yield from _wrapped(name, width, "  ")
            yield from _wrapped(text, width, "      ")
    if command.epilog:
        title, _, commands = command.epilog.partition(": ")
        yield from ("", f"{title}:")
        for each in commands.split("; "):
            yield from example(each, width)


def _sections(command: TyperCommand | TyperGroup, context: Any) -> dict[str, list[tuple[str, str]]]:  # noqa: ANN401
    """Return the names and descriptions of arguments, options and commands, under the titles of their panels."""
    sections: dict[str, list[tuple[str, str]]] = {}
    for param in command.get_params(context):
        record = param.get_help_record(context)
        if record:
            title = "Arguments" if isinstance(param, TyperArgument) else "Options"
            sections.setdefault(getattr(param, "rich_help_panel", None) or title, []).append(record)
    for name, each in getattr(command, "commands", {}).items():
        if not each.hidden:
            title = getattr(each, "rich_help_panel", None) or "Commands"
            sections.setdefault(title, []).append((name, each.short_help or each.help or ""))
    return sections


def _wrapped(text: str, width: int, first: str = "", rest: str | None = None) -> list[str]:
    return textwrap.wrap(
        " ".join(text.split()),
        width,
        initial_indent=first,
        subsequent_indent=first if rest is None else rest,
        break_long_words=False,
        break_on_hyphens=False,
    )

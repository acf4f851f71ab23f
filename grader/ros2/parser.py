"""The parsers of `ros2`, with usage, help and error messages as in the real command.

Only the module of the verb on the command line is imported, and that module imports rclpy only when the verb runs.
"""

from __future__ import annotations

import argparse
import importlib
import os
import re
import sys
from typing import TYPE_CHECKING, Any, NoReturn

from grader.common.terminal_text import hanging, say
from grader.ros.failure import did_you_mean
from grader.ros2.groups import GROUPS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

MODULES = {
    # xml is a package in Python's standard library.
    "pkg.xml": "pkg.manifest",
    "wtf": "doctor",
    **dict.fromkeys(("launch", "security", "doctor.hello", "wtf.hello"), "unsupported"),
    **dict.fromkeys(("component.load", "component.standalone", "component.unload"), "unsupported"),
}
"""Maps the name of a group or verb to the name of its module, if these names differ."""
_CHOICE = re.compile(r"invalid choice: '([^']*)' \(choose from (.*)\)")


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """A formatter that does not import shutil to get the width of the terminal."""

    def __init__(self, prog: str) -> None:
        columns = os.environ.get("COLUMNS", "")
        try:
            width = int(columns) if columns.isdecimal() and int(columns) else os.get_terminal_size(1).columns
        except OSError:
            width = 80
        self._narrow = 0 < width < 80
        # With argparse's own limit of 24 columns for the options, a narrow terminal has few columns for their texts.
        super().__init__(prog, width=(width or 80) - 2, max_help_position=6 if self._narrow else 24)

    def _format_usage(self, usage: Any, actions: Any, groups: Any, prefix: Any) -> str:  # noqa: ANN401 - as argparse
        if not self._narrow:
            return super()._format_usage(usage, actions, groups, prefix)
        # argparse indents the options by the length of the command's name, which leaves no room for long options.
        width, self._width = self._width, sys.maxsize
        line = super()._format_usage(usage, actions, groups, prefix).strip()
        self._width = width
        return hanging(line, width, rest="    ") + "\n\n"

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if not self._narrow:
            return super()._fill_text(text, width, indent)
        rest = {True: f"{indent}    ", False: indent}
        return "\n".join(hanging(line, width, indent, rest["  " in line]) for line in text.splitlines()) + "\n"

    def _format_action_invocation(self, action: argparse.Action) -> str:
        invocation = super()._format_action_invocation(action)
        return hanging(invocation, self._width - 2, rest="    ") if self._narrow else invocation


class Parser(argparse.ArgumentParser):
    """An argparse parser that suggests the most similar word if a choice is invalid."""

    def error(self, message: str) -> NoReturn:
        """Print an error message and exit with code 2."""
        invalid = invalid_choice(message)
        super().error(did_you_mean(*invalid, message) if invalid else message)

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        """Print the message to standard error, if there is one, and exit with the code `status`."""
        if message:
            say(message.rstrip("\n"))
        super().exit(status)


def invalid_choice(message: str) -> tuple[str, list[str]] | None:
    """Return the invalid word and the valid words in an error message of argparse, or None for any other message."""
    match = _CHOICE.search(message)
    return (match[1], re.findall(r"[\w-]+", match[2])) if match else None


def make_parser(words: Sequence[str], kind: type[Parser] = Parser) -> Parser:
    """Return the parser for a command line. `words` are the words after `ros2`. All parsers are of the class `kind`.

    The parser contains all groups of `ros2`. The verbs of a group and the arguments of a verb are added only for the
    group and the verb in `words`. The parsed arguments have the attribute `run`, a function that takes the arguments
    and returns the exit code.
    """
    chosen = [word for word in words if not word.startswith("-")]
    group, verb = [*chosen[:2], None, None][:2]
    root = kind(
        prog="ros2",
        description="ros2 is an extensible command-line tool for ROS 2.",
        formatter_class=_Formatter,
    )
    root.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="use Python's buffering of standard output: in a pipe, write blocks instead of lines",
    )
    root.set_defaults(run=_help_of(root))
    _add_words(root, "command", {name: group.about for name, group in GROUPS.items()}, group, _add_group(verb))
    return root


def _add_words(
    parser: Parser,
    kind: str,
    about: Mapping[str, str],
    chosen: str | None,
    add: Callable[[Parser, str], None],
) -> None:
    """Add the words in `about`. Only the `chosen` word gets its own parser, to which `add` adds the arguments."""
    width = max(map(len, about))
    words = parser.add_subparsers(
        title="Commands",
        description="".join(f"{name.ljust(width)}  {text}\n" for name, text in sorted(about.items())),
        metavar=f"Call `{parser.prog} <command> -h` for more detailed usage.",
        # The real ros2 uses the same name, which cannot be the name of an option.
        dest=f" {kind}",
        parser_class=type(parser),
    )
    for name in sorted(about):
        if name == chosen:
            made = words.add_parser(
                name, prog=f"{parser.prog} {name}", description=about[name], formatter_class=_Formatter
            )
            add(made, name)
        else:
            # Only the name is needed, and the parsers of all words would cost a third of the time of a command.
            words.choices[name] = parser


def _add_group(verb: str | None) -> Callable[[Parser, str], None]:
    def add(parser: Parser, name: str) -> None:
        group = GROUPS[name]
        for flag, text in group.flags.items():
            parser.add_argument(flag, action="store_true", help=text)
        if not group.verbs:
            _add_verb(parser, name)
            return
        if group.runs_itself:
            _add_verb(parser, name)
        else:
            parser.set_defaults(run=_help_of(parser))
        _add_words(parser, "verb", group.verbs, verb, lambda made, word: _add_verb(made, f"{name}.{word}"))

    return add


def _add_verb(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the arguments of a verb. The verb's module has the functions `add(parser)` and `run(args)`."""
    module = importlib.import_module(f"grader.ros2.{MODULES.get(name, name)}")
    module.add(parser)
    parser.set_defaults(run=module.run)


def _help_of(parser: argparse.ArgumentParser) -> Callable[[argparse.Namespace], int]:
    def print_help(_: argparse.Namespace) -> int:
        parser.print_help()
        return 0

    return print_help

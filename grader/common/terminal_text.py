"""Messages on a terminal: lines that are broken between words, and colours.

The set-up runs this module under any Python from 3.6 on, before anything is installed, so it uses only the syntax of
Python 3.6.
"""

import os
import re
import sys
import textwrap
from typing import List, Optional, TextIO

_COMMAND = re.compile(r"`[^`]*`|\b(?:source|cd)(?= ['/~.<])[^,;]*|\bsudo [a-z][^,;]*")
_OPTION = re.compile(r"(--[\w-]+) (?=[^-\s])")
BOLD, RED = "1", "31"
_SPACE = "\0"
"""A placeholder for a space at which a line must not be broken: inside a command, and between an option and its
value."""
_CONTROL = re.compile(r"(?!\x1b\[(?:0|1|31|33)m)[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Matches the characters of Unicode's category Cc, except line feeds, tabs, and the colours of our own messages. Also
matches the characters that set the direction of the text after them (UAX #9), because they can make a line look like
another one."""


def say(text: str, stream: Optional[TextIO] = None, style: str = "") -> None:
    """Print a message for users, to standard error by default.

    The message can contain the name of a student's folder, so control characters become question marks. On a terminal,
    lines are broken between words, and the message has the style (`BOLD` or `RED`) if the user wants colours.
    """
    stream = stream or sys.stderr
    shown = wrapped(without_control(text), columns(stream))
    print(f"\033[{style}m{shown}\033[0m" if style and has_colours(stream) else shown, file=stream, flush=True)


def without_control(text: str) -> str:
    r"""Return the text with a question mark in place of each character that `_CONTROL` matches.

    Example:
        >>> without_control("/a\x1b[2K\tb\n")
        '/a?[2K\tb\n'
    """
    return _CONTROL.sub("?", text)


def has_colours(stream: TextIO) -> bool:
    """Return whether the stream is a terminal with colours, and the user wants them (https://no-color.org)."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") not in ("dumb", "unknown")


def columns(stream: TextIO) -> Optional[int]:
    """Return the number of columns of a terminal, or None for a file or a pipe, in which lines may have any length."""
    try:
        if not stream.isatty():
            return None
        setting = os.environ.get("COLUMNS", "")
        width = int(setting) if setting.isdecimal() else os.get_terminal_size(stream.fileno()).columns
    except (OSError, ValueError):  # a closed stream, or one without a file descriptor
        return None
    return width or None


def wrapped(text: str, width: Optional[int]) -> str:
    """Return the text with line breaks between words, so that its lines have at most `width` columns.

    Text that users may copy is not broken: long words (such as paths), commands, and indented lines (which contain
    commands or code). The terminal itself breaks such text, and joins it again when it is copied.
    """
    return "\n".join(line if line[:1].isspace() else hanging(line, width) for line in text.split("\n"))


def hanging(line: str, width: Optional[int], first: str = "", rest: str = "") -> str:
    """Wrap a single line as `wrapped` does. The first part begins with `first`, and each other part with `rest`."""
    if width is None:
        return first + line
    together = _COMMAND.sub(lambda found: found[0].replace(" ", _SPACE), line)
    return "\n".join(_broken(together, width, first, rest)) or line


def example(command: str, width: int, indent: str = "  ") -> List[str]:
    """Return the lines of an example command. All lines but the last end with a backslash."""
    if len(indent + command) <= width:
        return [indent + command]
    *lines, last = _broken(_OPTION.sub("\\1" + _SPACE, command), width - 2, indent, indent * 2)
    return [line + " \\" for line in lines] + [last]


def _broken(text: str, width: int, first: str, rest: str) -> List[str]:
    lines = textwrap.wrap(
        text, width, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False
    )
    return [line.replace(_SPACE, " ") for line in lines]

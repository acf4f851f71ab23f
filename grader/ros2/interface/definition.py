"""The definition of an installed interface, including the definitions of its fields."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from collections.abc import Iterator

_FIELD = re.compile(r"\s*([A-Za-z][\w/]*)(<=\d+)?(\[[^\]]*\])?\s+[A-Za-z]")
_PRIMITIVE = re.compile(r"bool|byte|char|float(32|64)|u?int(8|16|32|64)|w?string")
_DEEPEST = 20
"""The maximum depth of nested types, because a type in a damaged file could contain itself."""


def lines(name: str, *, comments: bool = True, nested_comments: bool = False, depth: int = 0) -> Iterator[str]:
    """Yield the lines of an interface. Below a field that is a message, yield the lines of its type, indented by a tab.

    Without `comments`, empty lines are omitted, too.

    Raises:
        Ros2Error: the interface, or the type of one of its fields, is not installed or cannot be read.
    """
    file = index.interface_file(name)
    try:
        text = file.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        message = f"Could not find the interface '{name}': {file} could not be read"
        raise Ros2Error(message) from error
    for raw in text.splitlines():
        line = raw.rstrip() if comments else _strip_comment(raw)
        if line or comments:
            yield "\t" * depth + line if line else ""
        nested = _type_of(_without_comment(raw), name.split("/")[0])
        if nested and depth < _DEEPEST:
            yield from lines(nested, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1)


def _strip_comment(line: str) -> str:
    """Return the line as `--no-comments` prints it.

    After a field, if a space follows the #, the real `ros2` prints the #, and so does this function.
    """
    before = _without_comment(line)
    behind = line[len(before) :]
    if not before.strip() or not behind:
        return before.rstrip()
    return f"{before}#" if behind[1:2].isspace() else before.strip()


def _type_of(line: str, package: str) -> str | None:
    """Return the full name of a field's type, or None if the type is primitive or the line defines no field."""
    match = _FIELD.match(line)
    if match is None or _PRIMITIVE.fullmatch(match[1]):
        return None
    parts = match[1].split("/")
    return f"{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """Return the line without its comment. A # in the default value of a string does not start a comment."""
    quote = ""
    for place, char in enumerate(line):
        if quote:
            quote = "" if char == quote else quote
        elif char in "\"'":
            quote = char
        elif char == "#":
            return line[:place]
    return line

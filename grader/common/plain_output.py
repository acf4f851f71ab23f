"""Write to a terminal without control characters, because names and texts in the ROS graph can come from any program.

A terminal executes the control sequences in its output. Such a sequence can hide a line, write to the clipboard
(OSC 52), or make the printed address a link to another one (OSC 8).
"""

from __future__ import annotations

import io
import sys
from typing import TextIO

from grader.common.terminal_text import without_control


class PlainText(io.TextIOWrapper):
    """A text stream that replaces control characters as `without_control` does."""

    def write(self, text: str, /) -> int:
        """Write the text without control characters, and return the length of the text."""
        super().write(without_control(text))
        return len(text)


def protect_terminal() -> None:
    """Write all further output of this process to a terminal without control characters.

    Files and pipes get the unchanged text.
    """
    sys.stdout, sys.stderr = _protected(sys.stdout), _protected(sys.stderr)


def _protected(stream: TextIO) -> TextIO:
    if not isinstance(stream, io.TextIOWrapper) or not stream.isatty():
        return stream
    stream.flush()
    # The buffer is shared and not detached, because other code may have kept the stream.
    return PlainText(
        stream.buffer,
        stream.encoding,
        stream.errors,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )

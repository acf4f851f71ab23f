"""Disable commands to a continuous integration (CI) system in the output, which can contain text from a submission.

CI systems execute commands that they find in the log of a job. GitHub Actions executes `::command::` at the beginning
of a line, and the older `##[command]` anywhere (`ActionCommand.TryParseV2` and `TryParse` in actions/runner). Azure
Pipelines executes `##vso[command]` anywhere, and TeamCity `##teamcity[command]`. A space inside the marker makes it
plain text. GitLab's commands need control characters, which no report contains.
"""

from __future__ import annotations

import io
import re
import sys
from typing import TextIO

_MARKERS = re.compile(r"(?:^|[\r\n])[^\S\r\n]*::|##(?=\[|vso\[|teamcity\[)", re.IGNORECASE)
LONGEST = len("##teamcity[")
"""The length of the longest marker."""


def without_commands(text: str, before: str = "") -> str:
    """Return the text with a space in the marker of each command.

    `before` is the end of the text that is already on the same line.

    Example:
        >>> without_commands("::error::x ##vso[task.x]")
        ': :error::x # #vso[task.x]'
        >>> without_commands("[error]", before="x ##")
        ' [error]'
    """
    pieces, copied, joined = [], len(before), before + text
    for found in _MARKERS.finditer(joined):
        # A marker that began in an earlier text is broken where this text begins.
        at = max(found.end() - 1, len(before))
        pieces += [joined[copied:at], " "]
        copied = at
    return "".join([*pieces, joined[copied:]])


class LogText(io.TextIOWrapper):
    """A text stream that writes text without commands, even if a command arrives in pieces."""

    _before = ""

    def write(self, text: str, /) -> int:
        """Write the text without commands, and return the length of the text."""
        written = without_commands(text, self._before)
        super().write(written)
        line = re.split(r"[\r\n]", self._before + written)[-1].lstrip()
        # The end of a long line must not look like the beginning of a line.
        self._before = line if len(line) <= LONGEST else f"...{line[-LONGEST:]}"
        return len(text)


def protect_output() -> None:
    """Write all further output of this process without commands."""
    sys.stdout, sys.stderr = _protected(sys.stdout), _protected(sys.stderr)


def _protected(stream: TextIO) -> TextIO:
    if not isinstance(stream, io.TextIOWrapper) or isinstance(stream, LogText):
        return stream
    stream.flush()
    # The buffer is shared and not detached, because other code may have kept the stream.
    return LogText(
        stream.buffer,
        stream.encoding,
        stream.errors,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )

"""Read what a user gives: check a file before it is opened, and limit the size of standard input.

Opening a pipe can wait forever, and reading from a device may never end.
"""

from __future__ import annotations

import stat
import sys
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from pathlib import Path

MOST_BYTES = 10_000_000
"""The maximum size of a text (bytes): a parameter file, options, the metadata of a bag, or standard input."""
_OF_THE_SHELL = ("/dev/", "/proc/")
"""The folders of standard input and of the pipes in `<(COMMAND)`. Another program writes to these pipes."""
_KINDS = {
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFDIR: "a folder",
}


def why_not(path: Path, *, most: int | None = MOST_BYTES, piped: bool = False) -> str:
    """Return the reason why a path cannot be read as a file, or an empty string.

    A file may have at most `most` bytes, if this is not None. With `piped`, the path may be a pipe of the shell.
    """
    try:
        about = path.stat()
    except OSError as error:
        return error.strerror or str(error)
    kind = stat.S_IFMT(about.st_mode)
    if kind == stat.S_IFIFO and piped and str(path).startswith(_OF_THE_SHELL):
        return ""
    if kind != stat.S_IFREG:
        return f"it is {_KINDS.get(kind, 'something else')}, not a file"
    if most is not None and about.st_size > most:
        return f"it has more than {most / 1e6:.0f} MB"
    return ""


def standard_input() -> str:
    """Return the text on standard input.

    Raises:
        Ros2Error: the text is too long or not UTF-8.
    """
    data = sys.stdin.buffer.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        message = f"Standard input has more than {MOST_BYTES / 1e6:.0f} MB"
        raise Ros2Error(message)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        message = f"Standard input is not a text in UTF-8: {error}"
        raise Ros2Error(message) from error

"""Make the standard streams usable, even if they are closed or their encoding lacks some characters."""

from __future__ import annotations

import errno
import io
import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

_MODES = ("r", "w", "w")
_LOST = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO})
"""Errors which mean that the messages cannot be stored: the disk is full or broken, or the log file is too large."""


class _Messages(io.FileIO):
    """Standard error that discards messages if they cannot be stored, instead of raising an error.

    The progress and the messages of a command are less important than its results.
    """

    def write(self, data: ReadableBuffer, /) -> int:
        """Write the data, and return the number of bytes that were written, or that were lost on a full disk."""
        try:
            return super().write(data)
        except OSError as error:
            if error.errno not in _LOST:
                raise
            return memoryview(data).nbytes


def make_usable() -> None:
    """Reopen closed standard streams, and allow characters that the encoding of an output stream does not have.

    With `grader env >&-`, sys.stdout is None, and the next file that is opened would become the standard output of all
    child processes. If the encoding is not UTF-8, for example with PYTHONIOENCODING=ascii, a question mark is printed
    in place of each character that the encoding does not have. A file name that is not valid UTF-8 is printed as it is,
    in all locales as in C.UTF-8. If standard error is a file on a full disk, the messages are lost, and the command
    continues.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with suppress(OSError):  # this computer may not be able to open a file
                opened = _opened(number)
                # As in Python itself, the second name keeps the stream open when the first one is replaced.
                for each in (name, f"__{name}__"):
                    setattr(sys, each, opened)
    if isinstance(sys.stderr, io.TextIOWrapper) and not sys.stderr.isatty():
        sys.stderr.flush()
        raw = io.BufferedWriter(_Messages(sys.stderr.fileno(), "w", closefd=False))
        messages = io.TextIOWrapper(raw, sys.stderr.encoding, sys.stderr.errors, line_buffering=True)
        sys.stderr = sys.__stderr__ = messages  # type: ignore[misc]
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and not has_signs(stream.encoding):
            stream.reconfigure(errors="replace")
        elif isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors="surrogateescape")


def has_signs(encoding: str) -> bool:
    """Return whether the encoding has characters such as ✓ and →."""
    return encoding.lower().startswith("utf")


def _opened(number: int) -> io.TextIOBase:
    null = os.open(os.devnull, os.O_RDWR)
    if null != number:
        os.dup2(null, number)
        os.close(null)
    os.set_inheritable(number, True)  # noqa: FBT003 - has no keyword
    return open(number, _MODES[number], encoding="utf-8", closefd=False)  # type: ignore[return-value]

"""Standard streams to which a command can always write."""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress

_MODES = ("r", "w", "w")


def make_usable() -> None:
    """Reopen closed standard streams, and allow characters that the encoding of standard output does not have.

    With `grader env >&-`, sys.stdout is None, and the next file that is opened would become the standard output of all
    child processes. If the encoding is not UTF-8, for example with PYTHONIOENCODING=ascii, a question mark is printed
    in place of each character that the encoding does not have.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with suppress(OSError):  # this computer may not be able to open a file
                opened = _opened(number)
                # As in Python itself, the second name keeps the stream open when the first one is replaced.
                for each in (name, f"__{name}__"):
                    setattr(sys, each, opened)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and not has_signs(stream.encoding):
            stream.reconfigure(errors="replace")


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

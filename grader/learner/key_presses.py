"""Read single key presses from the terminal without waiting for Enter. Restore the terminal's settings afterwards."""

from __future__ import annotations

import os
import sys
import termios
import tty
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@contextmanager
def single_keys() -> Iterator[Callable[[], str] | None]:
    """Yield a function that waits for a key press and returns the key ("" at the end of input).

    If there is no terminal, yield None.
    """
    if not sys.stdin.isatty():
        yield None
        return
    fd = sys.stdin.fileno()
    before = termios.tcgetattr(fd)
    try:
        tty.setcbreak(fd)
        yield lambda: os.read(fd, 1).decode("ascii", "replace")
    finally:
        termios.tcsetattr(fd, termios.TCSADRAIN, before)

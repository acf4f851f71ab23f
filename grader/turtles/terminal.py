"""Keys from the terminal as they are pressed; the terminal is left as it was found, whatever happens."""

from __future__ import annotations

import os
import signal
import sys
import termios
import tty
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType


def is_terminal() -> bool:
    """Whether somebody can press keys here."""
    try:
        return os.isatty(sys.stdin.fileno())
    except (OSError, ValueError, AttributeError):
        # Closed, or none at all.
        return False


@contextmanager
def keyboard() -> Iterator[int]:
    """Standard input without echo and without waiting for Enter; Ctrl-C and Ctrl-Z work as ever. Gives its number."""
    number = sys.stdin.fileno()
    before = termios.tcgetattr(number)
    handlers: dict[signal.Signals, Any] = dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT), _end)
    handlers[signal.SIGCONT] = lambda *_: _in_front(number)
    old = {name: signal.signal(name, handler) for name, handler in handlers.items()}
    try:
        tty.setcbreak(number)
        yield number
    finally:
        # What was typed ahead is not for the shell: an arrow would call up its last command. The terminal may be gone.
        with suppress(termios.error):
            termios.tcsetattr(number, termios.TCSAFLUSH, before)
        for name, handler in old.items():
            signal.signal(name, handler)


def _end(number: int, _: FrameType | None) -> NoReturn:
    sys.exit(128 + number)


def _in_front(number: int) -> None:
    """After Ctrl-Z and fg the shell has made the terminal its own."""
    if os.tcgetpgrp(number) == os.getpgrp():
        tty.setcbreak(number)

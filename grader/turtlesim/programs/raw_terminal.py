"""Keys from the terminal as they are pressed; the terminal is left as it was found, whatever happens."""

from __future__ import annotations

import os
import select
import signal
import sys
import termios
import tty
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType


def is_terminal() -> bool:
    """Whether somebody can press keys here."""
    try:
        return os.isatty(sys.stdin.fileno())
    except (OSError, ValueError, AttributeError):
        # Closed, or none at all.
        return False


@contextmanager
def keyboard() -> Iterator[Callable[..., bytes | None]]:
    """Standard input without echo and without waiting for Enter; Ctrl-C and Ctrl-Z work as ever.

    Gives a function that waits for keys, at most so many seconds (for ever when none are named), and returns what they
    send: nothing when the terminal is gone, None when the time is up.
    """
    number = sys.stdin.fileno()
    before = termios.tcgetattr(number)
    handlers: dict[signal.Signals, Any] = dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT), _end)
    handlers[signal.SIGCONT] = lambda *_: _in_front(number)
    old = {name: signal.signal(name, handler) for name, handler in handlers.items()}
    woken, wake = os.pipe()
    os.set_blocking(wake, False)
    # A signal may reach another thread, one of ROS 2; then this one would go on waiting, and Python not handle it.
    old_wake = signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
    try:
        tty.setcbreak(number)
        yield partial(_read, number, woken)
    finally:
        # What was typed ahead is not for the shell: an arrow would call up its last command. The terminal may be gone.
        with suppress(termios.error):
            termios.tcsetattr(number, termios.TCSAFLUSH, before)
        signal.set_wakeup_fd(old_wake)
        for name, handler in old.items():
            signal.signal(name, handler)
        os.close(woken)
        os.close(wake)


def _read(number: int, woken: int, timeout_s: float | None = None) -> bytes | None:
    while True:
        ready, _, _ = select.select([number, woken], [], [], timeout_s)
        if not ready:
            return None
        if woken in ready:
            os.read(woken, 64)
        if number in ready:
            try:
                return os.read(number, 1024)
            except OSError:
                return b""


def _end(number: int, _: FrameType | None) -> NoReturn:
    sys.exit(128 + number)


def _in_front(number: int) -> None:
    """After Ctrl-Z and fg the shell has made the terminal its own."""
    if os.tcgetpgrp(number) == os.getpgrp():
        tty.setcbreak(number)

"""Read keys from the terminal as they are pressed. The settings of the terminal are restored, except after SIGKILL."""

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
    """Return whether standard input is a terminal."""
    try:
        return os.isatty(sys.stdin.fileno())
    except (OSError, ValueError, AttributeError):
        # Standard input is closed or missing.
        return False


@contextmanager
def keyboard() -> Iterator[Callable[..., bytes | None]]:
    """Read standard input without echo and without waiting for Enter. Ctrl-C and Ctrl-Z work as usual.

    Yields a function that waits for key presses and returns their bytes. The argument of the function is the timeout in
    seconds, or None to wait forever. The function returns b"" if the terminal has been closed, or None if the timeout
    expires.
    """
    number = sys.stdin.fileno()
    before = termios.tcgetattr(number)
    handlers: dict[signal.Signals, Any] = dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT), _end)
    handlers[signal.SIGCONT] = lambda *_: _in_front(number)
    old = {name: signal.signal(name, handler) for name, handler in handlers.items()}
    woken, wake = os.pipe()
    os.set_blocking(wake, False)
    # A signal may be delivered to another thread, such as a thread of ROS 2. Without the pipe, this thread would then
    # continue to wait, and Python would not handle the signal.
    old_wake = signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
    try:
        tty.setcbreak(number)
        yield partial(_read, number, woken)
    finally:
        # Discard keys that have not been read yet, since an arrow key would recall the last command in the shell. The
        # terminal may have been closed.
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
    """Apply the program's settings to the terminal again, which has the settings of the shell after Ctrl-Z and fg."""
    if os.tcgetpgrp(number) == os.getpgrp():
        tty.setcbreak(number)

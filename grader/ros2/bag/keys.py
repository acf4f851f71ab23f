"""The keys that control a recording and a playback."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from grader.turtlesim.programs.raw_terminal import is_terminal, keyboard

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SPACE, RIGHT, UP, DOWN = "SPACE", "CURSOR_RIGHT", "CURSOR_UP", "CURSOR_DOWN"
_BYTES = {b" ": SPACE, b"\x1b[C": RIGHT, b"\x1b[A": UP, b"\x1b[B": DOWN}


def available() -> bool:
    """Whether keys can be pressed here: standard input is a terminal."""
    return is_terminal()


@contextmanager
def pressed(*, enabled: bool) -> Iterator[Callable[[float], str]]:
    """Give a function that waits for a key for so many seconds, and returns its name; empty if none was pressed.

    Without a terminal, or where keys are not `enabled`, the function waits only.
    """
    if not enabled or not available():

        def wait(timeout_s: float) -> str:
            time.sleep(max(0.0, timeout_s))
            return ""

        yield wait
        return
    with keyboard() as read:

        def key(timeout_s: float) -> str:
            sent = read(max(0.0, timeout_s))
            if sent == b"":
                # The terminal has gone; the process goes on without it.
                time.sleep(max(0.0, timeout_s))
            return _BYTES.get(sent or b"", "")

        yield key

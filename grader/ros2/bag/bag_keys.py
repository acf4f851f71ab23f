"""The keys that control recording and playback."""

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
    """Return whether standard input is a terminal, so that a user can press keys."""
    return is_terminal()


@contextmanager
def pressed(*, enabled: bool) -> Iterator[Callable[[float], str]]:
    """Yield a function that takes a timeout (s), waits for a key, and returns the name of the key.

    The function returns an empty string if no key or a key without a name is pressed. Without a terminal, or if
    `enabled` is false, the function waits for the whole timeout.
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
                # The terminal was closed. Continue without it.
                time.sleep(max(0.0, timeout_s))
            return _BYTES.get(sent or b"", "")

        yield key

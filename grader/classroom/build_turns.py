"""Turns for builds: the workers of a class run colcon on at most half of the processors at the same time.

Nothing else in a grading needs as much memory as a build. While one worker builds, the others run trials.
"""

from __future__ import annotations

import fcntl
import os
import tempfile
import time
from contextlib import contextmanager, suppress
from functools import cache
from typing import IO, TYPE_CHECKING, Any

from grader.colcon import runner

if TYPE_CHECKING:
    from collections.abc import Iterator

WAIT_S = 10.0
"""After waiting for this time (s), a worker builds anyway, so that builds that hang do not hold up a class."""
_POLL_S = 0.01


@cache
def lock_file() -> IO[bytes]:
    """Return a file without a name, each byte of which is one turn.

    Processes that were forked after the first call share the file. The kernel releases the locks of a process when the
    process ends (F_SETLK in fcntl(2)).
    """
    return tempfile.TemporaryFile()


def turns() -> int:
    """Return the maximum number of builds at the same time."""
    return max(1, len(os.sched_getaffinity(0)) // 2)


def build_in_turn(*arguments: Any, **options: Any) -> runner.Built:  # noqa: ANN401 - the arguments of runner.build
    """Build a submission as `runner.build` does, but wait for a turn first."""
    with turn():
        return runner.build(*arguments, **options)


@contextmanager
def turn(wait_s: float = WAIT_S) -> Iterator[None]:
    """Wait up to `wait_s` for a turn, and keep the turn inside the context. On a system without locks, do not wait."""
    mine = None
    with suppress(OSError):
        until = time.monotonic() + wait_s
        while (mine := take()) is None and time.monotonic() < until:
            time.sleep(_POLL_S)
    try:
        yield
    finally:
        if mine is not None:
            fcntl.lockf(lock_file(), fcntl.LOCK_UN, 1, mine)


def take() -> int | None:
    """Take a turn that is free, and return its number. If none is free, return None.

    Raises:
        OSError: the system refuses the file or the lock.
    """
    file = lock_file()
    for number in range(turns()):
        with suppress(BlockingIOError, PermissionError):  # another process has this turn (fcntl(2))
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, number)
            return number
    return None

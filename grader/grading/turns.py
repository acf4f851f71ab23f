"""Turns: gradings share the machine, but a trial in wall time that is repeated has the machine to itself.

This concerns the gradings of one user only. The locks are flock(2): the kernel releases the locks of a process that is
killed. A grading that wants the machine alone holds a second lock, the turnstile, while it waits. Later gradings stop
there, so it does not wait for ever.
"""

from __future__ import annotations

import fcntl
import os
import time
from contextlib import ExitStack, contextmanager
from typing import IO, TYPE_CHECKING

from grader.common import xdg

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

WAIT_S = 120.0
"""After this time (s), a grading continues although the machine is not free."""
_POLL_S = 0.02


class Turns:
    """The turn of one grading. They all use the lock files in `folder`. Without it, nobody waits."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._locks: tuple[IO[bytes], IO[bytes]] | None = None
        """The lock files of the turnstile and the machine, while the machine is shared."""

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Share the machine with other gradings."""
        with ExitStack() as stack:
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                turnstile = stack.enter_context(open(self._folder / "turnstile", "ab"))  # noqa: PTH123
                machine = stack.enter_context(open(self._folder / "machine", "ab"))  # noqa: PTH123
            except OSError:
                yield
                return
            _lock(turnstile, fcntl.LOCK_SH)
            _lock(machine, fcntl.LOCK_SH)
            fcntl.flock(turnstile, fcntl.LOCK_UN)
            self._locks = turnstile, machine
            try:
                yield
            finally:
                self._locks = None

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Have the machine alone. Use this inside `shared`."""
        if self._locks is None:
            yield
            return
        turnstile, machine = self._locks
        # Release the share first: two gradings that want the machine alone would wait for each other.
        fcntl.flock(machine, fcntl.LOCK_UN)
        _lock(turnstile, fcntl.LOCK_EX)
        _lock(machine, fcntl.LOCK_EX)
        try:
            yield
        finally:
            fcntl.flock(machine, fcntl.LOCK_SH)
            fcntl.flock(turnstile, fcntl.LOCK_UN)


def _lock(file: IO[bytes], how: int) -> None:
    until = time.monotonic() + WAIT_S
    while not _locked(file, how) and time.monotonic() < until:
        time.sleep(_POLL_S)


def _locked(file: IO[bytes], how: int) -> bool:
    try:
        fcntl.flock(file, how | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks: nobody waits
        pass
    return True


def folder() -> Path:
    """Return the folder of the lock files of this user."""
    return xdg.cache() / f"turns-{os.getuid()}"

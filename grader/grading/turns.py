"""Whose turn it is on this machine: gradings share it, but a wall-clock trial that is made again has it to itself.

As far as gradings of one user go; nobody else is asked. Locks are the kernel's (flock): whoever is killed lets go.
Whoever wants the machine alone holds a turnstile while waiting, so that those who come later do not keep it waiting for
ever.
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
"""A machine that does not become free by then is used all the same."""
_POLL_S = 0.02


class Turns:
    """One grading's place among the others; `folder` is where all of them look. Without one nobody waits."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._locks: tuple[IO[bytes], IO[bytes]] | None = None
        """The turnstile and the machine, while it is shared."""

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Use the machine beside others."""
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
        """Inside of `shared`: have the machine to oneself."""
        if self._locks is None:
            yield
            return
        turnstile, machine = self._locks
        # Two that want it must not wait for each other's share.
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
    """Where the gradings of this user look."""
    return xdg.cache() / f"turns-{os.getuid()}"

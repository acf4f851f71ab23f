"""Turns: graders share the machine, but a trial that is repeated in wall time has the machine to itself.

Only grader processes of the same user take turns. The locks use flock(2), so the kernel releases them when a process is
killed. A grader that needs the machine to itself holds a second lock, the turnstile, while it waits. Graders that
arrive later must wait for this second lock, so the waiting grader does not wait forever.
"""

from __future__ import annotations

import fcntl
import os
import time
from contextlib import ExitStack, contextmanager
from typing import IO, TYPE_CHECKING

from grader.common import xdg

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

WAIT_S = 120.0
"""After waiting for this time (s), a grader continues even if other graders are still using the machine."""
_POLL_S = 0.02


class Turns:
    """Lets several graders share the machine, or one grader use it exclusively.

    All graders use the lock files in `folder`. If these files cannot be used, no grader waits for another grader.
    `tell` is called with a short message if this grader has to wait.
    """

    def __init__(self, folder: Path, tell: Callable[[str], object] = lambda _: None) -> None:
        self._folder = folder
        self._tell = tell
        self._locks: tuple[IO[bytes], IO[bytes]] | None = None
        """While this grader shares the machine, the two lock files (turnstile and machine). At other times, None."""

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Share the machine with other graders."""
        with ExitStack() as stack:
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                turnstile = stack.enter_context(open(self._folder / "turnstile", "ab"))  # noqa: PTH123
                machine = stack.enter_context(open(self._folder / "machine", "ab"))  # noqa: PTH123
            except OSError:
                yield
                return
            self._lock(turnstile, fcntl.LOCK_SH)
            self._lock(machine, fcntl.LOCK_SH)
            fcntl.flock(turnstile, fcntl.LOCK_UN)
            self._locks = turnstile, machine
            try:
                yield
            finally:
                self._locks = None

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Use the machine exclusively. Call this inside `shared`."""
        if self._locks is None:
            yield
            return
        turnstile, machine = self._locks
        # Release the shared lock first. Otherwise, two graders that want the machine to themselves would wait for each
        # other.
        fcntl.flock(machine, fcntl.LOCK_UN)
        self._lock(turnstile, fcntl.LOCK_EX)
        self._lock(machine, fcntl.LOCK_EX)
        try:
            yield
        finally:
            fcntl.flock(machine, fcntl.LOCK_SH)
            fcntl.flock(turnstile, fcntl.LOCK_UN)

    def _lock(self, file: IO[bytes], how: int) -> None:
        if _locked(file, how):
            return
        self._tell("Waiting until another grader on this machine has finished")
        until = time.monotonic() + WAIT_S
        while not _locked(file, how) and time.monotonic() < until:
            time.sleep(_POLL_S)


def _locked(file: IO[bytes], how: int) -> bool:
    try:
        fcntl.flock(file, how | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # the file system does not support locks, so no grader waits
        pass
    return True


def folder() -> Path:
    """Return the folder that contains the lock files of this user."""
    return xdg.cache() / f"turns-{os.getuid()}"

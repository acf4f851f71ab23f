"""A temporary folder of a process. If the process is killed, the next process that needs such a folder removes it.

Each process locks its folders with flock(2), so the kernel releases the locks when the process ends. All folders are in
a folder that only this user can open, so no other user can choose what is removed.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.private_folder import users_folder

if TYPE_CHECKING:
    from collections.abc import Iterator

_PREFIX = "grader-"


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Yield a new, empty folder, and remove it at the end of the `with` block.

    The folders of processes that were killed are removed first.

    Raises:
        MachineError: the folder of this user cannot be used.
        OSError: the folder cannot be created, or its file system does not support locks.
    """
    above = users_folder()
    with ExitStack() as stack:
        # While this lock is held, no other process is between the creation of a folder and its lock.
        with _opened(above / "folders.lock", os.O_CREAT | os.O_WRONLY) as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for folder in above.glob(f"{_PREFIX}*"):
                _remove_unused(folder)
            made = tempfile.TemporaryDirectory(prefix=_PREFIX, dir=above, ignore_cleanup_errors=True)
            folder = Path(os.path.realpath(stack.enter_context(made)))
            fcntl.flock(stack.enter_context(_opened(folder)), fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield folder


def _remove_unused(folder: Path) -> None:
    """Remove the folder if no process has locked it."""
    try:
        with _opened(folder) as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)
    except (BlockingIOError, FileNotFoundError):
        pass  # a process uses the folder, or removed it at this moment


@contextmanager
def _opened(path: Path, flags: int = os.O_RDONLY) -> Iterator[int]:
    file = os.open(path, flags, mode=0o600)
    try:
        yield file
    finally:
        os.close(file)

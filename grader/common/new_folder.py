"""A folder that a command creates completely or not at all."""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from typing import TYPE_CHECKING

from grader.common.system_errors import path_and_reason
from grader.errors import MachineError, UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@contextmanager
def new_folder(folder: Path, mode: int = 0o777) -> Iterator[None]:
    """Create a folder, or use an empty folder. If the `with` block fails, the folder is restored to its previous state.

    Parent folders that were created remain.

    Raises:
        UsageError: the folder is not empty, or is a file.
        MachineError: the folder could not be created or written.
    """
    was_there = folder.exists()
    if was_there and (not folder.is_dir() or any(folder.iterdir())):
        message = f"{folder} is not an empty folder. Choose a new folder."
        raise UsageError(message)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=mode, exist_ok=True)
        yield
    except BaseException as error:
        left = "" if _removed(folder, was_there=was_there) else f" Remove {folder} before you try again."
        if not isinstance(error, OSError):
            raise
        path, reason = path_and_reason(error)
        message = f"{path or folder} could not be written: {reason}.{left}"
        raise MachineError(message) from error


def _removed(folder: Path, *, was_there: bool) -> bool:
    """Remove the content of the folder, and the folder itself unless it `was_there`. Return whether nothing is left."""
    try:
        for entry in folder.iterdir():
            shutil.rmtree(entry, ignore_errors=True) if entry.is_dir() else entry.unlink()
        if was_there:
            return not any(folder.iterdir())
        folder.rmdir()
    except OSError:
        return not folder.exists()
    return True

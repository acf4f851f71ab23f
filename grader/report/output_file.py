"""Write files that the user named on the command line.

The file may be in a student's folder, where the student may have put a symbolic link to a file of the user. Therefore,
symbolic links are not followed, except those of the system, such as /dev/stdout. A student may also have put a named
pipe there, so the grader does not wait until a process reads from the file.
"""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING

from grader.common.system_errors import of_the_machine
from grader.errors import MachineError, UsageError

if TYPE_CHECKING:
    from pathlib import Path


_OF_THE_SYSTEM = ("/dev/", "/proc/")


def check_writable(file: Path | None) -> None:
    """Check that the user may write the file, and that the path is not a folder. Call this before doing any work.

    Raises UsageError if the file cannot be written, or if it is `-`, which means standard output in many programs.
    """
    if str(file) == "-":
        message = "The file cannot be -, since the command prints its own text on standard output. Choose a file name."
        raise UsageError(message)
    if file is not None and not file.absolute().parent.is_dir():
        message = f"There is no folder {file.absolute().parent} to write {file.name} to."
        raise UsageError(message)
    if file is not None and file.is_dir():
        message = f"{file} is a folder. Choose a file name."
        raise UsageError(message)
    if file is not None and file.is_symlink() and not _is_of_the_system(file):
        raise UsageError(_link(file))
    if file is not None and not os.access(file if file.exists() else file.absolute().parent, os.W_OK):
        message = f"{file} cannot be written: {os.strerror(errno.EACCES)}."
        raise UsageError(message)


def write(file: Path, content: bytes) -> None:
    """Write the file.

    Raises:
        UsageError: the path is not valid or not writable.
        MachineError: the disk is full, or the machine failed in another way.
    """
    try:
        # With O_NONBLOCK, opening a pipe without a reader fails. Otherwise, it would wait for ever.
        safely = 0 if _is_of_the_system(file) else os.O_NOFOLLOW | os.O_NONBLOCK
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | safely, 0o666)
        if safely:
            os.set_blocking(descriptor, True)
        with os.fdopen(descriptor, "wb") as opened:
            opened.write(content)
    except OSError as error:
        raise not_written(file, error) from error


def not_written(file: Path, error: OSError) -> UsageError | MachineError:
    """Return the error to raise if a file could not be written: UsageError or MachineError, with the reason."""
    if error.errno == errno.ELOOP and file.is_symlink():
        return UsageError(_link(file))
    if error.errno == errno.ENXIO:
        return UsageError(f"{file} is a pipe or a socket that no program reads. Remove it, or choose another name.")
    message = f"{file} cannot be written: {error.strerror or error}."
    return MachineError(message) if of_the_machine(error) else UsageError(message)


def _is_of_the_system(file: Path) -> bool:
    return str(file.absolute()).startswith(_OF_THE_SYSTEM)


def _link(file: Path) -> str:
    return f"{file} is a symbolic link, which can lead to any file. Remove it, or choose another file name."

"""Files that a command writes because somebody named them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path


def check_writable(file: Path | None) -> None:
    """Check that a file can be written, before time is spent on its content. Raises UsageError."""
    if file is not None and not file.absolute().parent.is_dir():
        message = f"There is no folder {file.absolute().parent} to write {file.name} to."
        raise UsageError(message)
    if file is not None and file.is_dir():
        message = f"{file} is a folder; name a file."
        raise UsageError(message)


def write(file: Path, content: bytes) -> None:
    """Write the file. Raises UsageError where that fails."""
    try:
        file.write_bytes(content)
    except OSError as error:
        message = f"{file} could not be written: {error.strerror}."
        raise UsageError(message) from error

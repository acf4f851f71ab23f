"""Write a file completely or not at all, also when the disk is full or the process is killed."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

PARTIAL = ".partial"
"""The end of the name of the unfinished file, which a process that is killed leaves in the folder."""


def write_whole(file: Path, content: bytes, *, mode: int | None = None) -> None:
    """Replace the file, or create it. Until the new content is on the disk, the old file stays as it is.

    `mode` are the permissions, for example 0o755. Without it, they are those of any new file. Only one process at a
    time may write the file.

    Raises:
        OSError: the file cannot be written. An old file is unchanged.
    """
    partial = file.with_name(f".{file.name}{PARTIAL}")
    try:
        with partial.open("wb") as opened:
            opened.write(content)
            opened.flush()
            os.fsync(opened.fileno())
        if mode is not None:
            partial.chmod(mode)
        partial.replace(file)
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)

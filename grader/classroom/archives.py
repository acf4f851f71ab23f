"""Unpack a student's archive into a temporary folder.

The archive is read in the process that reads students' files (unpack.py). This module writes the result to the folder.
"""

from __future__ import annotations

import errno
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from grader.classroom.unpack import (
    ArchiveFormatError,
    DamagedArchiveError,
    LargeArchiveError,
    Member,
    read_archive,
)
from grader.errors import DiskError, TooLargeError
from grader.submission import reader
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ENDINGS = (".zip", ".tar.gz", ".tgz", ".tar")
OTHER_ENDINGS = (".7z", ".rar", ".tar.xz", ".tar.bz2", ".tar.zst", ".gz", ".xz", ".bz2")
"""Formats of archives that students sometimes hand in, although these formats are not supported."""
EVERY_ENDING = (*ENDINGS, *OTHER_ENDINGS)
OF_THE_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS)


def stem(name: str) -> str | None:
    """Return the name of an archive without its extension, or None if the file is not an archive."""
    ending = next((each for each in EVERY_ENDING if name.lower().endswith(each)), None)
    return name[: -len(ending)] or None if ending else None


@contextmanager
def unpacked(archive: Path) -> Iterator[Path]:
    """Yield a temporary folder with the content of the archive.

    The absolute path of the archive must not contain a link.

    Raises:
        NotUnpackedError: the archive cannot be unpacked, or is larger than a submission may be.
        DiskError: the disk for temporary files failed.
    """
    if not archive.name.lower().endswith(ENDINGS):
        message = "is not a supported archive: hand in a .zip or a .tar.gz"
        raise ArchiveFormatError(message)
    members = _read(archive)
    with tempfile.TemporaryDirectory(prefix="grader-unpacked-") as named:
        folder = Path(os.path.realpath(named))
        _write_all(members, folder)
        del members
        yield folder


def _read(archive: Path) -> tuple[Member, ...]:
    try:
        return reader.read(read_archive, archive)
    except TooLargeError as error:
        message = f"could not be unpacked within {reader.CPU_S} s and {reader.MEMORY // 1024**3} GiB of memory"
        raise LargeArchiveError(message) from error


def _write_all(members: Iterable[Member], folder: Path) -> None:
    try:
        for member in members:
            _write(member, folder)
    except OSError as error:
        if error.errno in OF_THE_DISK:
            message = (
                f"A submission could not be unpacked: {error.strerror}. Free some space in {tempfile.gettempdir()}, or "
                "set another folder with TMPDIR, and try again."
            )
            raise DiskError(message) from error
        message = f"is damaged, or contains a file name that the disk does not accept ({error.strerror})"
        raise DamagedArchiveError(message) from error
    except ValueError as error:  # a NUL in a name
        message = f"is damaged, or contains a file name that the disk does not accept ({error})"
        raise DamagedArchiveError(message) from error


def _write(member: Member, folder: Path) -> None:
    """Write a file, or make a folder. As with unzip and tar, a file of the same name is replaced."""
    target = folder.joinpath(*member.parts)
    try:
        (target if member.content is None else target.parent).mkdir(parents=True, exist_ok=True)
        if member.content is not None:
            target.write_bytes(member.content)
            target.chmod(0o755 if member.executable else 0o644)
    except (FileExistsError, NotADirectoryError, IsADirectoryError) as error:
        message = f"contains {shown('/'.join(member.parts))} both as a file and as a folder"
        raise DamagedArchiveError(message) from error

"""Copy a student's archive, and unpack the copy into a temporary folder.

The student can replace the archive at any time, so the copy is hashed while it is made: the hash is always that of the
files that are graded. The copy is read in the process that reads students' files (unpack.py). This module writes the
result to the folder.
"""

from __future__ import annotations

import errno
import hashlib
import os
import tempfile
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING

from grader.classroom.unpack import (
    MOST_PACKED,
    ArchiveFormatError,
    DamagedArchiveError,
    LargeArchiveError,
    Member,
    not_opened,
    read_archive,
    too_large,
)
from grader.common.temporary_folder import temporary_folder
from grader.errors import DiskError, TooLargeError
from grader.submission import reader, tree
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

ENDINGS = (".zip", ".tar.gz", ".tgz", ".tar")
OTHER_ENDINGS = (".7z", ".rar", ".tar.xz", ".tar.bz2", ".tar.zst", ".gz", ".xz", ".bz2")
"""Formats of archives that students sometimes hand in, although these formats are not supported."""
EVERY_ENDING = (*ENDINGS, *OTHER_ENDINGS)
_CHUNK = 1024 * 1024
OF_THE_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS)


def stem(name: str) -> str | None:
    """Return the name of an archive without its extension, or None if the name has no stem or another extension."""
    ending = next((each for each in EVERY_ENDING if name.lower().endswith(each)), None)
    return name[: -len(ending)] or None if ending else None


@dataclass(frozen=True)
class Copy:
    """A copy of an archive in a folder of the grader. `sha256` is the hash of the archive's name and content.

    If the archive could not be read or is too large to be unpacked, `error` is the reason. Then `sha256` is the hash of
    the name, of the part that was read, and of the error that occurred while reading, if any.
    """

    file: Path
    name: str
    """The name of the archive. The copy has another name, because the disk for temporary files may not accept this
    name."""
    sha256: str
    error: Exception | None

    @contextmanager
    def unpacked(self) -> Iterator[Path]:
        """Yield a temporary folder with the content of the archive.

        Raises the same errors as the function `unpacked`, and those of `not_opened`.
        """
        if self.error is not None:
            reason = not_opened(self.error, self.name)
            raise reason from (None if reason is self.error else self.error)
        with unpacked(self.file) as folder:
            yield folder


@contextmanager
def copied(archive: Path) -> Iterator[Copy]:
    """Yield a copy of the archive. The absolute path of the archive must not contain a link.

    Raises:
        DiskError: the disk for temporary files failed.
    """
    with _temporary_folder() as folder:
        ending = next((each for each in ENDINGS if archive.name.lower().endswith(each)), "")
        file = folder / f"archive{ending}"
        with _file_of_ours(file) as target:
            sha256, error = _hashed(archive, target if ending else None)
        yield Copy(file, archive.name, sha256, error)


def sha256_of(archive: Path) -> str:
    """Return the hash that a copy of the archive would have now, without making one."""
    return _hashed(archive)[0]


def _hashed(archive: Path, target: IO[bytes] | None = None) -> tuple[str, Exception | None]:
    """Return the hash of an archive's name and content, and the reason why it cannot be unpacked, or None.

    The content is also written to `target`.
    """
    whole = hashlib.sha256(archive.name.encode("utf-8", "surrogateescape") + b"\0")
    size = 0
    try:
        with tree.open_file(archive, at=archive) as file:
            # If the archive is too large to be unpacked, hashing this part of it is enough.
            while size <= MOST_PACKED and (data := file.read(_CHUNK)):
                size += len(data)
                whole.update(data)
                if target is not None:
                    _write_to(target, data)
    except (OSError, ValueError) as error:
        whole.update(f"cannot be read: {error}".encode())
        return whole.hexdigest(), error
    return whole.hexdigest(), too_large() if size > MOST_PACKED else None


@contextmanager
def _temporary_folder() -> Iterator[Path]:
    with ExitStack() as stack:
        try:
            folder = stack.enter_context(temporary_folder())
        except OSError as error:
            raise _disk_error(error) from error
        yield folder


@contextmanager
def _file_of_ours(file: Path) -> Iterator[IO[bytes]]:
    try:
        opened = file.open("xb", buffering=0)
    except OSError as error:
        raise _disk_error(error) from error
    with opened:
        yield opened


def _write_to(target: IO[bytes], data: bytes) -> None:
    """Write all data. Raises DiskError, and not the error of the archive that is being read."""
    view = memoryview(data)
    try:
        while view:
            view = view[target.write(view) :]
    except OSError as error:
        raise _disk_error(error) from error


def _disk_error(error: OSError) -> DiskError:
    return DiskError(
        f"A submission could not be unpacked: {error.strerror}. Free some space in {tempfile.gettempdir()}, or set "
        "another folder with TMPDIR, and try again."
    )


@contextmanager
def unpacked(archive: Path) -> Iterator[Path]:
    """Yield a temporary folder with the content of the archive.

    The absolute path of the archive must not contain a link.

    Raises:
        NotUnpackedError: the archive cannot be unpacked, or is larger than a submission may be.
        DiskError: the disk for temporary files failed.
        MachineError: the machine failed while the archive was being read.
    """
    if not archive.name.lower().endswith(ENDINGS):
        message = "is not a supported archive: hand in a .zip or a .tar.gz"
        raise ArchiveFormatError(message)
    members = _read(archive)
    with _temporary_folder() as folder:
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
            raise _disk_error(error) from error
        message = f"is damaged, or contains a file name that the disk does not accept ({error.strerror})"
        raise DamagedArchiveError(message) from error
    except ValueError as error:  # a NUL in a name
        message = f"is damaged, or contains a file name that the disk does not accept ({error})"
        raise DamagedArchiveError(message) from error


def _write(member: Member, folder: Path) -> None:
    """Write a file, or make a folder or a link. As with unzip and tar, a file of the same name is replaced.

    Nothing is written through a link. `read_archive` returns no member below a link, but two names can be the same on a
    disk that ignores capital letters.
    """
    target = folder.joinpath(*member.parts)
    if os.path.realpath(target.parent) != os.path.join(os.path.realpath(folder), *member.parts[:-1]):  # noqa: PTH118
        message = f"contains {shown('/'.join(member.parts))} below a link"
        raise DamagedArchiveError(message)
    try:
        is_folder = member.content is None and not member.link
        (target if is_folder else target.parent).mkdir(parents=True, exist_ok=True)
        if member.link:
            target.unlink(missing_ok=True)
            target.symlink_to(member.link)
        elif member.content is not None:
            if target.is_symlink():
                target.unlink()
            target.write_bytes(member.content)
            target.chmod(0o755 if member.executable else 0o644)
    except (FileExistsError, NotADirectoryError, IsADirectoryError) as error:
        message = f"contains {shown('/'.join(member.parts))} both as a file and as a folder"
        raise DamagedArchiveError(message) from error

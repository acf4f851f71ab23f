"""Unpack an archive that a student handed in: `python -I -S unpack.py ARCHIVE FOLDER`.

archives.py runs this script in a separate process with limits. The script uses only the standard library, creates only
plain files and folders inside the given folder, and never exceeds the limits below. The script prints JSON: {"why":
null} on success; otherwise, "why" completes a sentence that begins with the name of the archive. The script exits with
code 3 if the disk fails.
"""

from __future__ import annotations

import errno
import gzip
import io
import json
import os
import stat
import sys
import tarfile
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

MOST_BYTES = 96 * 1024 * 1024
"""The maximum unpacked size (bytes): 1.5 times the size limit of a package, with space for build/ and install/."""
MOST_ENTRIES = 20_000
MOST_DEPTH = 40
MOST_PATH_BYTES = 1000
CHUNK = 256 * 1024
DISK_FAILED = 3
OF_THE_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS)


class RefusedError(Exception):
    """The archive cannot be unpacked. The message states why."""


class Capped(io.RawIOBase):
    """A stream that returns at most `most` bytes."""

    def __init__(self, stream: IO[bytes], most: int) -> None:
        self._stream, self._left = stream, most

    def readable(self) -> bool:
        """Return True."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Read some bytes. Raises RefusedError if the limit is exceeded."""
        data = self._stream.read(min(size, CHUNK) if size >= 0 else CHUNK)
        self._left -= len(data)
        if self._left < 0:
            raise RefusedError(_too_much())
        return data


def _too_much() -> str:
    return f"unpacks to more than the {MOST_BYTES // 1024 // 1024} MiB that a submission may have"


def unpack(archive: Path, folder: Path) -> None:
    """Unpack into an empty folder. Raises RefusedError if the archive is refused, or OSError if the disk fails."""
    with archive.open("rb") as file:
        members = _zip(file) if zipfile.is_zipfile(file) else _tar(file)
        left = MOST_BYTES
        for number, (name, mode, content) in enumerate(members, 1):
            if number > MOST_ENTRIES:
                message = f"contains more than {MOST_ENTRIES} entries"
                raise RefusedError(message)
            target = folder.joinpath(*_parts(name))
            if content is None:
                _make_folder(target, folder)
            else:
                left -= _write(content, target, folder, mode, left)


def _zip(file: IO[bytes]) -> Iterator[tuple[str, int, IO[bytes] | None]]:
    """Yield the name, mode and content of each file.

    For a folder, the content is None. Links and devices are skipped.
    """
    with zipfile.ZipFile(file) as packed:
        for info in packed.infolist():
            mode = info.external_attr >> 16
            # Some programs for Windows use backslashes as separators.
            name = info.filename.replace("\\", "/")
            if name.endswith("/"):
                yield name, mode, None
            elif stat.S_IFMT(mode) in (0, stat.S_IFREG):
                if info.flag_bits & 1:
                    message = "is locked with a password"
                    raise RefusedError(message)
                with packed.open(info) as content:
                    yield name, mode, content


def _tar(file: IO[bytes]) -> Iterator[tuple[str, int, IO[bytes] | None]]:
    """Yield the same values as `_zip`, but for a tar archive, which may be compressed with gzip."""
    file.seek(0)
    gzipped = file.read(2) == b"\x1f\x8b"
    file.seek(0)
    stream: IO[bytes] = gzip.GzipFile(fileobj=file) if gzipped else file  # type: ignore[assignment]
    # A header takes 512 bytes, and long names and dates need additional headers.
    capped = Capped(stream, MOST_BYTES + 2048 * MOST_ENTRIES)
    with tarfile.open(fileobj=capped, mode="r|") as packed:
        for info in packed:
            if info.isdir():
                yield info.name, info.mode, None
            elif info.isreg():
                yield info.name, info.mode, packed.extractfile(info)


def _parts(name: str) -> tuple[str, ...]:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        message = f"contains a path that leads out of it: {_shown(name)}"
        raise RefusedError(message)
    if len(path.parts) > MOST_DEPTH or len(os.fsencode(name)) > MOST_PATH_BYTES:
        message = f"contains a path that is too long: {_shown(name[:60])}..."
        raise RefusedError(message)
    return path.parts


def _shown(text: str) -> str:
    return "".join(char if char.isprintable() else "?" for char in text)


def _make_folder(target: Path, folder: Path) -> None:
    try:
        target.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        raise RefusedError(_both(target, folder)) from error


def _both(target: Path, folder: Path) -> str:
    return f"contains {_shown(str(target.relative_to(folder)))} both as a file and as a folder"


def _write(content: IO[bytes], target: Path, folder: Path, mode: int, most: int) -> int:
    """Write a file and return its size. As with unzip and tar, a file of the same name is replaced."""
    _make_folder(target.parent, folder)
    if target.is_dir():
        raise RefusedError(_both(target, folder))
    size = 0
    with target.open("wb") as file:
        while data := content.read(CHUNK):
            size += len(data)
            if size > most:
                raise RefusedError(_too_much())
            file.write(data)
    target.chmod(0o755 if mode & stat.S_IXUSR else 0o644)
    return size


def main(archive: str, folder: str) -> int:
    """Unpack the archive and print whether that was possible."""
    why = None
    try:
        unpack(Path(archive), Path(folder))
    except RefusedError as error:
        why = str(error)
    except (zipfile.BadZipFile, tarfile.TarError, zlib.error, EOFError, gzip.BadGzipFile) as error:
        why = f"is not a .zip or .tar.gz, or is damaged ({_shown(str(error))[:200]})"
    except (NotImplementedError, RuntimeError, UnicodeError) as error:
        why = f"is compressed with a method that is not supported ({_shown(str(error))[:200]})"
    except MemoryError:
        why = "needs more memory to unpack than a submission may take"
    except OSError as error:
        detail = _shown(str(error.strerror or error))[:200]
        if error.errno in OF_THE_DISK and error.filename != archive:
            print(json.dumps({"why": detail}))
            return DISK_FAILED
        why = f"is damaged, or contains a name that no disk accepts ({detail})"
    except Exception as error:
        # A damaged archive can make the modules raise other errors too.
        why = f"is not a .zip or .tar.gz, or is damaged ({type(error).__name__}: {_shown(str(error))[:200]})"
    print(json.dumps({"why": why}))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

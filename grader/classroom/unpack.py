"""Unpack an archive that a student handed in: `python -I -S unpack.py ARCHIVE FOLDER`.

Runs in a process of its own under limits (archives.py), with the standard library alone. Only plain files and folders
are made, only inside the folder, never more than the limits below. Prints JSON: {"why": null} when all went well, else
why it cannot be unpacked, as a part of a sentence that begins with the archive's name. Ends with 3 where
the disk fails.
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
"""Unpacked: half as much again as is read of a package, since build/ and install/ often come along."""
MOST_ENTRIES = 20_000
MOST_DEPTH = 40
MOST_PATH_BYTES = 1000
CHUNK = 256 * 1024
DISK_FAILED = 3
OF_THE_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS)


class RefusedError(Exception):
    """The archive is none that can be unpacked; the text says why."""


class Capped(io.RawIOBase):
    """A stream that refuses to give more than `most` bytes."""

    def __init__(self, stream: IO[bytes], most: int) -> None:
        self._stream, self._left = stream, most

    def readable(self) -> bool:
        """It is."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Some bytes. Raises RefusedError beyond the limit."""
        data = self._stream.read(min(size, CHUNK) if size >= 0 else CHUNK)
        self._left -= len(data)
        if self._left < 0:
            raise RefusedError(_too_much())
        return data


def _too_much() -> str:
    return f"unpacks to more than the {MOST_BYTES // 1024 // 1024} MiB that a submission may have"


def unpack(archive: Path, folder: Path) -> None:
    """Unpack into an empty folder. Raises RefusedError for what cannot be, OSError where the disk fails."""
    with archive.open("rb") as file:
        members = _zip(file) if zipfile.is_zipfile(file) else _tar(file)
        left = MOST_BYTES
        for number, (name, mode, content) in enumerate(members, 1):
            if number > MOST_ENTRIES:
                message = f"holds more than {MOST_ENTRIES} entries"
                raise RefusedError(message)
            target = folder.joinpath(*_parts(name))
            if content is None:
                _make_folder(target, folder)
            else:
                left -= _write(content, target, folder, mode, left)


def _zip(file: IO[bytes]) -> Iterator[tuple[str, int, IO[bytes] | None]]:
    """Name, mode and content of each file; a folder has no content; links and devices are passed over."""
    with zipfile.ZipFile(file) as packed:
        for info in packed.infolist():
            mode = info.external_attr >> 16
            # Some programs for Windows write its separators.
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
    """As `_zip`, of a tar archive, compressed with gzip or not."""
    file.seek(0)
    gzipped = file.read(2) == b"\x1f\x8b"
    file.seek(0)
    stream: IO[bytes] = gzip.GzipFile(fileobj=file) if gzipped else file  # type: ignore[assignment]
    # A header takes 512 bytes, and its names and dates may take as much again.
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
        message = f"holds a path that leads out of it: {_shown(name)}"
        raise RefusedError(message)
    if len(path.parts) > MOST_DEPTH or len(os.fsencode(name)) > MOST_PATH_BYTES:
        message = f"holds a path that is too long: {_shown(name[:60])}..."
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
    return f"holds {_shown(str(target.relative_to(folder)))} both as a file and as a folder"


def _write(content: IO[bytes], target: Path, folder: Path, mode: int, most: int) -> int:
    """Write a file, over one of the same name, as unzip and tar do; return its size."""
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
    """Unpack; say why that could not be done."""
    why = None
    try:
        unpack(Path(archive), Path(folder))
    except RefusedError as error:
        why = str(error)
    except (zipfile.BadZipFile, tarfile.TarError, zlib.error, EOFError, gzip.BadGzipFile) as error:
        why = f"is no .zip or .tar.gz, or a damaged one ({_shown(str(error))[:200]})"
    except (NotImplementedError, RuntimeError, UnicodeError) as error:
        why = f"is packed in a way that is not read here ({_shown(str(error))[:200]})"
    except MemoryError:
        why = "needs more memory to unpack than a submission may take"
    except OSError as error:
        said = _shown(str(error.strerror or error))[:200]
        if error.errno in OF_THE_DISK and error.filename != archive:
            print(json.dumps({"why": said}))
            return DISK_FAILED
        why = f"is a damaged archive, or holds a name that no disk takes ({said})"
    except Exception as error:
        # Whatever else a damaged archive makes the modules above raise.
        why = f"is no .zip or .tar.gz, or a damaged one ({type(error).__name__}: {_shown(str(error))[:200]})"
    print(json.dumps({"why": why}))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

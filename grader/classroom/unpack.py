"""Read a student's archive, in the process that reads students' files (submission/reader.py).

The result contains only plain files and folders, with checked paths, within the limits that this module defines.
archives.py writes the result to the disk.
"""

from __future__ import annotations

import gzip
import io
import os
import posixpath
import stat
import tarfile
import zipfile
import zlib
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING, ClassVar

from grader.errors import UnreadableError
from grader.submission import tree

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from grader.checks.diagnosis import Diagnosis

MOST_PACKED = 100 * 1024 * 1024
"""The maximum size of an archive (bytes)."""
MOST_BYTES = 96 * 1024 * 1024
"""The maximum unpacked size (bytes): 1.5 times the size limit of a package, so that build/ and install/ fit too."""
MOST_ENTRIES = 20_000
MOST_DEPTH = 40
MOST_LINKS = 8
"""The maximum number of links that are followed to find a file."""
MOST_PATH_BYTES = 1000
CHUNK = 256 * 1024


class NotUnpackedError(UnreadableError):
    """The student's archive cannot be unpacked.

    The message completes a sentence that begins with the name of the archive. Each subclass has its own `diagnosis`.
    """

    diagnosis: ClassVar[Diagnosis] = "unreadable"


class DamagedArchiveError(NotUnpackedError):
    """The archive is damaged, is not an archive, or contains a path that is not valid."""

    diagnosis: ClassVar[Diagnosis] = "archive-damaged"


class ArchiveFormatError(NotUnpackedError):
    """The archive has an unsupported format, an unsupported compression, or a password."""

    diagnosis: ClassVar[Diagnosis] = "archive-format"


class LargeArchiveError(NotUnpackedError):
    """The archive exceeds a limit: size, number of entries, length or depth of a path, time or memory for unpacking."""

    diagnosis: ClassVar[Diagnosis] = "submission-too-large"


@dataclass(frozen=True)
class Member:
    """A file in an archive, or a folder if `content` is None. `parts` are the names in the path of the member.

    If `link` is not empty, the member is a symbolic link with this target. No other member is below it.
    """

    parts: tuple[str, ...]
    content: bytes | None = None
    executable: bool = False
    link: str = ""


@dataclass(frozen=True)
class _Link:
    """A link in an archive: the path in the archive to which it leads, and the target of a symbolic link as it is."""

    inside: str
    symbolic: str = ""


class Capped(io.RawIOBase):
    """A stream that raises LargeArchiveError if more than `most` bytes are read from it."""

    def __init__(self, stream: IO[bytes], most: int) -> None:
        self._stream, self._left = stream, most

    def readable(self) -> bool:
        """Return True."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Read some bytes. Raises LargeArchiveError if the limit is exceeded."""
        data = self._stream.read(min(size, CHUNK) if size >= 0 else CHUNK)
        self._left -= len(data)
        if self._left < 0:
            raise LargeArchiveError(_too_much())
        return data


def _too_much() -> str:
    return f"is larger than the allowed {MOST_BYTES // 1024 // 1024} MiB after unpacking"


def read_archive(archive: Path) -> tuple[Member, ...]:
    """Return the files and folders in an archive. The absolute path of the archive must not contain a link.

    Raises:
        NotUnpackedError: the archive cannot be unpacked, or is larger than a submission may be.
        MachineError: the machine is at fault.
    """
    with _open(archive) as file:
        try:
            return tuple(_members(file))
        except NotUnpackedError:
            raise
        except MemoryError as error:
            message = "needs more memory to unpack than a submission may use"
            raise LargeArchiveError(message) from error
        except (zipfile.BadZipFile, tarfile.TarError, zlib.error, EOFError, gzip.BadGzipFile) as error:
            message = f"is not a .zip or .tar.gz, or is damaged ({_shown(str(error))[:200]})"
            raise DamagedArchiveError(message) from error
        except RecursionError as error:  # tarfile calls itself for each header that describes the next one
            message = "is nested too deeply to be unpacked"
            raise LargeArchiveError(message) from error
        except RuntimeError as error:  # NotImplementedError, too
            message = f"is compressed with a method that is not supported ({_shown(str(error))[:200]})"
            raise ArchiveFormatError(message) from error
        except Exception as error:
            # A damaged archive can make the modules raise other errors too, such as UnicodeError.
            detail = f"{type(error).__name__}: {_shown(str(error))[:200]}"
            message = f"is not a .zip or .tar.gz, or is damaged ({detail})"
            raise DamagedArchiveError(message) from error


def _open(archive: Path) -> IO[bytes]:
    try:
        file = tree.open_file(archive, at=archive)
    except (OSError, ValueError) as error:
        raise not_opened(error, archive.name) from error
    if os.fstat(file.fileno()).st_size <= MOST_PACKED:
        return file
    file.close()
    raise too_large()


def too_large() -> LargeArchiveError:
    """Return the error for an archive that is too large."""
    return LargeArchiveError(f"is larger than {MOST_PACKED // 1024 // 1024} MiB")


def not_opened(error: Exception, name: str) -> NotUnpackedError:
    """Return the error for an archive with this name that could not be opened or read.

    Raises:
        MachineError: the machine is at fault.
    """
    if isinstance(error, NotUnpackedError):
        return error
    if isinstance(error, OSError):
        return NotUnpackedError(tree.reason(error, name))
    return NotUnpackedError(f"could not be read ({_shown(str(error))})")


def _members(file: IO[bytes]) -> Iterator[Member]:
    left = MOST_BYTES
    files: dict[tuple[str, ...], Member] = {}
    links: dict[tuple[str, ...], _Link] = {}
    folders: set[tuple[str, ...]] = set()
    for number, (name, mode, content) in enumerate(_zip(file) if zipfile.is_zipfile(file) else _tar(file), 1):
        if number > MOST_ENTRIES:
            message = f"contains more than {MOST_ENTRIES} entries"
            raise LargeArchiveError(message)
        parts = _parts(name)
        links.pop(parts, None)
        folders.update(parts[:end] for end in range(1, len(parts)))
        if isinstance(content, _Link):
            links[parts] = content
            continue
        data = None if content is None else _content(content, left)
        left -= len(data or b"")
        member = Member(parts, data, executable=bool(mode & stat.S_IXUSR))
        if data is None:
            folders.add(parts)
        else:
            files[parts] = member
        yield member
    # In a folder, a link to a file of the same package counts as this file. Any other link is judged as in a folder.
    for parts, link in links.items():
        found = _behind(link.inside, files, links)
        if found is None:
            # No member is below a link, since it would be written to the place where the link leads.
            if link.symbolic and parts not in folders:
                yield Member(parts, link=link.symbolic)
            continue
        left -= len(found.content or b"")
        if left < 0:
            raise LargeArchiveError(_too_much())
        yield replace(found, parts=parts)


def _behind(
    target: str, files: Mapping[tuple[str, ...], Member], links: Mapping[tuple[str, ...], _Link]
) -> Member | None:
    """Return the file in the archive that a link leads to, perhaps through other links, or None."""
    for _ in range(MOST_LINKS):
        parts = PurePosixPath(posixpath.normpath(target)).parts
        if parts not in links:
            return files.get(parts)
        target = links[parts].inside
    return None


def _content(content: IO[bytes], most: int) -> bytes:
    data = bytearray()
    while chunk := content.read(CHUNK):
        data += chunk
        if len(data) > most:
            raise LargeArchiveError(_too_much())
    return bytes(data)


def _zip(file: IO[bytes]) -> Iterator[tuple[str, int, IO[bytes] | _Link | None]]:
    """Yield the name, mode and content of each file, folder and link.

    For a folder, the content is None. Devices are skipped.
    """
    with zipfile.ZipFile(file) as packed:
        for info in packed.infolist():
            mode = info.external_attr >> 16
            # Some programs for Windows use backslashes as separators.
            name = info.filename.replace("\\", "/")
            if name.endswith("/"):
                yield name, mode, None
            elif stat.S_IFMT(mode) in (0, stat.S_IFREG, stat.S_IFLNK):
                if info.flag_bits & 1:
                    message = "is protected with a password"
                    raise ArchiveFormatError(message)
                with packed.open(info) as content:
                    if stat.S_ISLNK(mode):
                        yield name, mode, _symbolic(name, os.fsdecode(content.read(MOST_PATH_BYTES)))
                    else:
                        yield name, mode, content


def _symbolic(name: str, target: str) -> _Link:
    return _Link(posixpath.join(posixpath.dirname(name), target), target)


def _tar(file: IO[bytes]) -> Iterator[tuple[str, int, IO[bytes] | _Link | None]]:
    """Yield the same values as `_zip`, but for a tar archive, with or without compression by gzip."""
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
            elif info.issym():
                yield info.name, info.mode, _symbolic(info.name, info.linkname)
            elif info.islnk():
                yield info.name, info.mode, _Link(info.linkname)


def _parts(name: str) -> tuple[str, ...]:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        message = f'contains an absolute path, or a path with "..": {_shown(name)}'
        raise DamagedArchiveError(message)
    if len(path.parts) > MOST_DEPTH or len(os.fsencode(name)) > MOST_PATH_BYTES:
        message = f"contains a path that is too long or too deep: {_shown(name[:60])}..."
        raise LargeArchiveError(message)
    return path.parts


def _shown(text: str) -> str:
    return "".join(char if char.isprintable() else "?" for char in text)

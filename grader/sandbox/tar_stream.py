"""Read a tar stream that an untrusted process may have written.

Python's tarfile is not safe for hostile archives. Some versions of tarfile followed nested headers until the stack
overflowed, looped forever because of negative sizes, or spent hours in a regular expression. This reader advances by at
least one block per step and stops at the first block that it cannot parse. The reader supports only the output of GNU
tar with --format=gnu.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

BLOCK = 512
_FILES = (b"0", b"\0", b"2")
"""The type flags of regular files in new and old archives, and of symbolic links."""
_LONG_NAME, _LONG_LINK = b"L", b"K"
_MOST_NAME = 4096


@dataclass(frozen=True)
class Member:
    """The position and size of a file's content in the stream (bytes), its type flag, and its permissions."""

    start: int
    size: int
    kind: bytes
    mode: int

    def content(self, stream: bytes) -> bytes:
        """Return the content of the file."""
        return stream[self.start : self.start + self.size]


def read_tar(stream: bytes, most: int) -> dict[PurePosixPath, Member]:
    """Return at most `most` files and symbolic links from the stream.

    Absolute paths, and paths that contain "..", are ignored. If the stream is damaged, only files before the damage are
    returned.
    """
    found: dict[PurePosixPath, Member] = {}
    for path, member in _members(stream):
        if len(found) == most:
            break
        if member.kind in _FILES and path.parts and not path.is_absolute() and ".." not in path.parts:
            found[path] = member
    return found


def read_all(stream: bytes, most: int) -> list[tuple[PurePosixPath, Member]] | None:
    """Return all members of the stream with their names, or None if the stream is damaged or has too many members."""
    found = list(islice(_members(stream), most + 1))
    end = _end(found[-1][1]) if found else 0
    return found if len(found) <= most and not stream[end:].strip(b"\0") else None


def _members(stream: bytes) -> Iterator[tuple[PurePosixPath, Member]]:
    """Yield the members up to the end of the stream or up to the first damaged member."""
    at, long_name = 0, None
    while at + BLOCK <= len(stream):
        header = stream[at : at + BLOCK]
        size, mode = _number(header[124:136]), _number(header[100:108])
        if size is None or _number(header[148:156]) != _sum(header) or at + BLOCK + size > len(stream):
            break
        member = Member(at + BLOCK, size, header[156:157], mode or 0)
        at = _end(member)
        if member.kind == _LONG_NAME:
            long_name = stream[member.start : member.start + min(size, _MOST_NAME)]
            continue
        if member.kind == _LONG_LINK:
            continue
        name = (long_name or header[:100]).split(b"\0", 1)[0]
        long_name = None
        yield PurePosixPath(name.decode("utf-8", "surrogateescape")), member


def _end(member: Member) -> int:
    """Return the position of the next header."""
    return member.start + (member.size + BLOCK - 1) // BLOCK * BLOCK


def _number(field: bytes) -> int | None:
    """Return the value of an octal field, or None if it is not octal: large numbers have a binary form."""
    digits = field.strip(b" \0")
    return int(digits, 8) if digits and not digits.strip(b"01234567") else None


def _sum(header: bytes) -> int:
    """Return the sum of the header's bytes, with spaces in place of the checksum field."""
    return sum(header) - sum(header[148:156]) + 8 * ord(" ")

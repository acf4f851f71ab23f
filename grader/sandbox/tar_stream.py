"""Read a tar stream that a stranger's process may have written.

The module tarfile is made for archives that mean well: its versions have followed nested headers until the stack ran
out, looped over sizes below zero, and spent hours in a regular expression. Here every step moves forward by at least
one block, and what is not understood ends the reading: what GNU tar writes with --format=gnu, and no more.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath

BLOCK = 512
_FILES = (b"0", b"\0", b"2")
"""Type flags of files, in new and old archives, and of symbolic links."""
_LONG_NAME, _LONG_LINK = b"L", b"K"
_MOST_NAME = 4096


@dataclass(frozen=True)
class Member:
    """Where a file's content lies in the stream (bytes)."""

    start: int
    size: int


def read_tar(stream: bytes, most: int) -> dict[PurePosixPath, Member]:
    """The files and links of the stream, at most so many; of what is no tar, those before it went wrong."""
    found: dict[PurePosixPath, Member] = {}
    at, long_name = 0, None
    while at + BLOCK <= len(stream) and len(found) < most:
        header = stream[at : at + BLOCK]
        size = _number(header[124:136])
        if size is None or _number(header[148:156]) != _sum(header) or at + BLOCK + size > len(stream):
            break
        start, kind = at + BLOCK, header[156:157]
        at = start + (size + BLOCK - 1) // BLOCK * BLOCK
        if kind == _LONG_NAME:
            long_name = stream[start : start + min(size, _MOST_NAME)]
            continue
        if kind == _LONG_LINK:
            continue
        name = (long_name or header[:100]).split(b"\0", 1)[0]
        long_name = None
        path = PurePosixPath(name.decode("utf-8", "surrogateescape"))
        if kind in _FILES and path.parts and not path.is_absolute() and ".." not in path.parts:
            found[path] = Member(start, size)
    return found


def _number(field: bytes) -> int | None:
    """An octal number; None for anything else, the binary form for numbers beyond 8 GiB or below zero included."""
    digits = field.strip(b" \0")
    return int(digits, 8) if digits and not digits.strip(b"01234567") else None


def _sum(header: bytes) -> int:
    """The sum of the header's bytes, its own field counted as blanks."""
    return sum(header) - sum(header[148:156]) + 8 * ord(" ")

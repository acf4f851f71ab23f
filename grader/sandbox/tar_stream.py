"""Read a tar stream that an untrusted process may have written.

Python's tarfile is not safe for hostile archives. Some versions of tarfile followed nested headers until the stack
overflowed, looped over negative sizes, or spent hours in a regular expression. This reader advances by at least one
block per step and stops at the first block that it cannot parse. The reader supports only the output of GNU tar with
--format=gnu.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath

BLOCK = 512
_FILES = (b"0", b"\0", b"2")
"""The type flags of regular files in new and old archives, and of symbolic links."""
_LONG_NAME, _LONG_LINK = b"L", b"K"
_MOST_NAME = 4096


@dataclass(frozen=True)
class Member:
    """The position and size of a file's content in the stream (bytes)."""

    start: int
    size: int


def read_tar(stream: bytes, most: int) -> dict[PurePosixPath, Member]:
    """Return at most `most` files and links of the stream.

    If the stream is damaged, only files before the damage are returned.
    """
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
    """Return the value of an octal field, or None for anything else, such as the binary form of large numbers."""
    digits = field.strip(b" \0")
    return int(digits, 8) if digits and not digits.strip(b"01234567") else None


def _sum(header: bytes) -> int:
    """Return the sum of the header's bytes, with spaces in place of the checksum field."""
    return sum(header) - sum(header[148:156]) + 8 * ord(" ")

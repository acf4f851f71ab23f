"""The instructions of a seccomp filter for x86-64. A filter is a program for the kernel's BPF virtual machine."""

from __future__ import annotations

import errno
import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Line = tuple[int, int, int, int]
"""A struct sock_filter: an operation, the number of instructions to skip if its result is true, the number of
instructions to skip if its result is false, and a value."""

LOAD, AND, EQUAL, AT_LEAST, ANY_BIT, RETURN = 0x20, 0x54, 0x15, 0x35, 0x45, 0x06
ALLOW, ERRNO = 0x7FFF0000, 0x00050000
_NUMBER, _ARCHITECTURE, _ARGUMENTS = 0, 4, 16
_X86_64, _X32 = 0xC000003E, 0x40000000


def argument(index: int, *, high: bool = False) -> int:
    """Return the offset of the low or the high 32 bits of an argument in struct seccomp_data."""
    return _ARGUMENTS + 8 * index + 4 * high


def begin() -> list[Line]:
    """Return a filter's first instructions: refuse calls from other architectures, and load the system call number."""
    absent = ERRNO | errno.ENOSYS
    lines = [(LOAD, 0, 0, _ARCHITECTURE), (EQUAL, 1, 0, _X86_64), (RETURN, 0, 0, absent)]
    return [*lines, (LOAD, 0, 0, _NUMBER), (AT_LEAST, 0, 1, _X32), (RETURN, 0, 0, absent)]


def refusing(numbers: Iterable[int], error: int) -> list[Line]:
    """Return the instructions that make these system calls fail with this error number."""
    return [line for number in numbers for line in ((EQUAL, 0, 1, number), (RETURN, 0, 0, ERRNO | error))]


def refusing_options(
    number: int, index: int, options: Sequence[int], error: int, *, level: int | None = None
) -> list[Line]:
    """Return the instructions that make a system call fail if its argument at this index is one of these options.

    With `level`, the call fails only if the argument at `index - 1` has this value.
    """
    lines = [] if level is None else [(LOAD, 0, 0, argument(index - 1)), (EQUAL, 1, 0, level), (RETURN, 0, 0, ALLOW)]
    refused = [(EQUAL, len(options) - at, 0, option) for at, option in enumerate(options)]
    lines += [(LOAD, 0, 0, argument(index)), *refused, (RETURN, 0, 0, ALLOW), (RETURN, 0, 0, ERRNO | error)]
    return [(EQUAL, 0, len(lines), number), *lines]


def packed(lines: Iterable[Line]) -> bytes:
    """Return the filter in the binary format of the kernel."""
    return b"".join(struct.pack("HBBI", *line) for line in lines)

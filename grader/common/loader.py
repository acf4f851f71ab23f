"""Start a program so that /proc/PID/exe is not the file of the program.

/proc/PID/exe leads to the file that a process executes, past all read-only mounts of a sandbox. If this file belonged
to the user of the sandbox, as a Python does that a user has installed, code in the sandbox could change it. If the
dynamic loader of the system executes the program, the file is the loader, which belongs to root.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_HEADER = struct.Struct("<4sBB26xQ14xHH")
"""Of an ELF file (elf(5)): the magic number, the class, the byte order; the place, size and number of its segments."""
_SEGMENT = struct.Struct("<I4xQ16xQ16x")
"""The kind, place and length of a segment."""
_ELF, _64_BITS, _LITTLE_ENDIAN, _INTERPRETER = b"\x7fELF", 2, 1, 3


def loaded(argv: Sequence[str]) -> list[str]:
    """Return the command that runs the program `argv[0]`, an absolute path, with its dynamic loader.

    Return `argv` itself if the program has no loader, as a script or a static program.
    """
    loader = _loader(argv[0])
    return [*([loader] if loader else []), *argv]


def _loader(program: str) -> str:
    """Return the path of the dynamic loader that an ELF file of 64 bits names, or an empty string."""
    with open(program, "rb") as file:  # noqa: PTH123 - a resolved path would hide a virtual environment
        header = file.read(_HEADER.size)
        if len(header) < _HEADER.size:
            return ""
        magic, bits, order, place, size, count = _HEADER.unpack(header)
        if (magic, bits, order) != (_ELF, _64_BITS, _LITTLE_ENDIAN):
            return ""
        file.seek(place)
        table = file.read(size * count)
        for number in range(count):
            kind, offset, length = _SEGMENT.unpack_from(table, number * size)
            if kind == _INTERPRETER:
                file.seek(offset)
                return file.read(length).rstrip(b"\0").decode()
    return ""

"""Start a program in such a way that the link /proc/PID/exe does not lead to the file of the program.

/proc/PID/exe leads to the file that a process executes. The read-only mounts of a sandbox do not protect a file that is
opened through this link. If the file belonged to the user of the sandbox (for example, a Python that this user has
installed), code in the sandbox could change the file. If the system's dynamic loader runs the program, /proc/PID/exe
leads instead to the loader, which belongs to root.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_HEADER = struct.Struct("<4sBB26xQ14xHH")
"""Values in the header of an ELF file (elf(5)): the magic number, the class and the byte order; the offset of the
program header table, and the size and the number of its entries."""
_SEGMENT = struct.Struct("<I4xQ16xQ16x")
"""Values in an entry of the program header table: the type, offset and length of a segment."""
_ELF, _64_BITS, _LITTLE_ENDIAN, _INTERPRETER = b"\x7fELF", 2, 1, 3


def loaded(argv: Sequence[str]) -> list[str]:
    """Return the command that runs the program `argv[0]`, an absolute path, with its dynamic loader.

    Return `argv` unchanged if the program needs no loader: a script or a statically linked program.
    """
    loader = _loader(argv[0])
    return [*([loader] if loader else []), *argv]


def _loader(program: str) -> str:
    """Return the path of the dynamic loader that a 64-bit ELF file names, or "" if it names none or is no such file."""
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

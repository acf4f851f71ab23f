"""Use /proc/net/tcp and tcp6 (proc(5)) to find the user who opened a connection from this machine."""

from __future__ import annotations

import os
import socket
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

_TABLES = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))


def is_of_another_user(client: tuple[str, int] | None) -> bool:
    """Return whether someone other than this user or root opened the connection with this address and port.

    Return False if the user is not known.
    """
    return client is not None and any(user not in (0, os.getuid()) for user in _users(*client))


def _users(host: str, port: int) -> Iterator[int]:
    """Yield the user id of each local socket with this address. A socket on another machine is not found."""
    # The kernel writes addresses as hexadecimal numbers in the byte order of the processor.
    address = f"{int.from_bytes(socket.inet_aton(host), 'little'):08X}"
    names = (f"{address}:{port:04X}", f"0000000000000000FFFF0000{address}:{port:04X}")
    for table in _TABLES:
        with suppress(OSError):
            for line in table.read_text("ascii").splitlines()[1:]:
                words = line.split()
                if words[1] in names:
                    yield int(words[7])

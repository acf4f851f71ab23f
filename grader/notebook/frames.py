"""The format of a kernel's messages on the pipe between the relay (outside the cell) and the bridge (inside).

A frame is a ZeroMQ message with its channel: one byte for the channel, two for the number of parts, and four for the
size of each part, all big-endian, followed by the parts. The reader gets the size of a message before its content.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

CHANNELS = ("shell", "control", "stdin", "iopub")
"""The channels. A frame contains the index of its channel in this list."""
ORDER = len(CHANNELS)
"""The channel of the first frame. The first frame contains the key for the signatures."""
CHUNK = 1024 * 1024
"""The maximum number of bytes that are read from or written to a pipe at a time."""
MOST_PARTS = 1000

_HEAD = struct.Struct(">BH")
_SIZE = 4


class FrameError(ValueError):
    """A kernel sent data that is not a message, or it sent more than a limit allows.

    The error message completes a sentence that begins with "The kernel sent".
    """


def packed(channel: int, parts: Sequence[bytes]) -> bytes:
    """Return a message as a frame."""
    sizes = b"".join(len(part).to_bytes(_SIZE, "big") for part in parts)
    return b"".join((_HEAD.pack(channel, len(parts)), sizes, *parts))


class Unpacker:
    """Splits the bytes of a pipe into messages. `most` is the maximum size of a message (bytes), or None."""

    def __init__(self, most: int | None = None) -> None:
        self._most = most
        self._data = bytearray()

    def feed(self, data: bytes) -> Iterator[tuple[int, list[bytes]]]:
        """Add bytes, and yield each complete message with its channel.

        Raises:
            FrameError: the channel does not exist, or the message is too large or has too many parts. After this, no
                message can be read.
        """
        self._data += data
        while (sizes := self._sizes()) is not None:
            start = _HEAD.size + _SIZE * len(sizes)
            if len(self._data) < start + sum(sizes):
                return
            channel, parts = self._data[0], []
            for size in sizes:
                parts.append(bytes(self._data[start : start + size]))
                start += size
            del self._data[:start]
            yield channel, parts

    def _sizes(self) -> list[int] | None:
        """Return the sizes of the parts of the next message (bytes), or None if some sizes have not arrived."""
        if len(self._data) < _HEAD.size:
            return None
        channel, count = _HEAD.unpack_from(self._data)
        if channel > ORDER or count > MOST_PARTS:
            message = "data that is not a Jupyter message"
            raise FrameError(message)
        if len(self._data) < _HEAD.size + _SIZE * count:
            return None
        sizes = list(struct.unpack_from(f">{count}I", self._data, _HEAD.size))
        if self._most is not None and sum(sizes) > self._most:
            message = f"a message of more than {self._most // 1024**2} MiB"
            raise FrameError(message)
        return sizes

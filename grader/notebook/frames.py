"""Frames: messages of a kernel on a pipe. Relay (outside of the cell) and bridge (inside) speak them.

A frame is a message of ZeroMQ with its channel: one byte for the channel, two for the number of parts, four for the
size of each part, all big-endian, then the parts. So the reader knows how large a message is before it takes any of it.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

CHANNELS = ("shell", "control", "stdin", "iopub")
"""A frame names its channel by the place in this list."""
ORDER = len(CHANNELS)
"""The channel of the first frame of all, which tells the bridge the key of the signatures."""
CHUNK = 1024 * 1024
"""Bytes that are read from a pipe at a time."""
MOST_PARTS = 1000

_HEAD = struct.Struct(">BH")
_SIZE = 4


class FrameError(ValueError):
    """What came is not a frame, or too large to be taken; the text says which."""


def packed(channel: int, parts: Sequence[bytes]) -> bytes:
    """A message as a frame."""
    sizes = b"".join(len(part).to_bytes(_SIZE, "big") for part in parts)
    return b"".join((_HEAD.pack(channel, len(parts)), sizes, *parts))


class Unpacker:
    """Makes messages of the bytes of a pipe; `most` is how large one may be (bytes), without limit if None."""

    def __init__(self, most: int | None = None) -> None:
        self._most = most
        self._data = bytearray()

    def feed(self, data: bytes) -> Iterator[tuple[int, list[bytes]]]:
        """Take what was read, and yield the messages that are complete now, each with its channel.

        Raises:
            FrameError: the channel does not exist, or the message is too large. Nothing after it can be read.
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
        """The sizes of the parts of the next message (bytes); None while they have not arrived."""
        if len(self._data) < _HEAD.size:
            return None
        channel, count = _HEAD.unpack_from(self._data)
        if channel > ORDER or count > MOST_PARTS:
            message = "what is no message of a kernel"
            raise FrameError(message)
        if len(self._data) < _HEAD.size + _SIZE * count:
            return None
        sizes = list(struct.unpack_from(f">{count}I", self._data, _HEAD.size))
        if self._most is not None and sum(sizes) > self._most:
            message = f"a message of more than {self._most // 1024**2} MiB"
            raise FrameError(message)
        return sizes

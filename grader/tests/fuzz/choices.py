"""Decisions derived from bytes, so that a fuzzer that changes the bytes tries other decisions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Sequence

T = TypeVar("T")


class Choices:
    """Reads decisions from the beginning of `data`. When no data are left, the decisions are 0 or empty."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def __bool__(self) -> bool:
        """Return whether any data are left."""
        return self._at < len(self._data)

    def take(self, most: int) -> bytes:
        """Return at most this number of bytes from the front of `data`."""
        taken = self._data[self._at : self._at + most]
        self._at += len(taken)
        return taken

    def below(self, end: int) -> int:
        """Return a number from 0 to `end` - 1."""
        return int.from_bytes(self.take(1 if end <= 256 else 2), "little") % end

    def one_of(self, values: Sequence[T]) -> T:
        """Return one of the values."""
        return values[self.below(len(values))]

    def rest(self) -> bytes:
        """Return all remaining bytes."""
        return self.take(len(self._data))

"""Decisions drawn from bytes, so that other bytes lead to other decisions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Sequence

T = TypeVar("T")


class Choices:
    """Takes decisions from the front of `data`; 0 and nothing when there is none left."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def __bool__(self) -> bool:
        """Whether there is something left."""
        return self._at < len(self._data)

    def take(self, most: int) -> bytes:
        """The next bytes, at most so many."""
        taken = self._data[self._at : self._at + most]
        self._at += len(taken)
        return taken

    def below(self, end: int) -> int:
        """A number from 0 to `end` - 1."""
        return int.from_bytes(self.take(1 if end <= 256 else 2), "little") % end

    def one_of(self, values: Sequence[T]) -> T:
        """One of the values."""
        return values[self.below(len(values))]

    def rest(self) -> bytes:
        """All that is left."""
        return self.take(len(self._data))

"""Send updates to all pages. Each update is serialized once. A page that was hidden gets the whole state."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

KEPT = 16
"""A page may lag behind by this number of messages (half a second) before it gets the whole state again."""


class Hub:
    """The updates in order, each with a number. `whole` returns the whole state for a new page."""

    def __init__(self, whole: Callable[[], dict[str, object]]) -> None:
        self._whole = whole
        self._news: deque[str] = deque(maxlen=KEPT)
        self._number = 0
        """The number of the next update."""
        self._written: tuple[int, str] = (-1, "")
        self._pages: set[asyncio.Event] = set()
        self.wholes = 0
        """The number of times that a page got the whole state."""

    @property
    def pages(self) -> int:
        """The number of visible pages that receive updates."""
        return len(self._pages)

    def tell(self, kind: str, news: dict[str, object]) -> None:
        """Send an update to all visible pages."""
        self._number += 1
        if self._pages:
            self._news.append(_text(kind, news))
        else:
            self._news.clear()
        for page in self._pages:
            page.set()

    async def follow(self, send: Callable[[str], Awaitable[None]]) -> None:
        """Send the whole state and then all updates to a page, until the coroutine is cancelled.

        `send` waits for a slow page. If the page misses updates because it is too slow, it gets the whole state again.
        """
        woken = asyncio.Event()
        self._pages.add(woken)
        try:
            next_ = -1
            while True:
                woken.clear()
                if next_ < self._number - len(self._news):
                    # Read the number before sending, so that updates that arrive in the meantime count as new.
                    next_, text = self._number, self._all()
                    self.wholes += 1
                    await send(text)
                while self._number - len(self._news) <= next_ < self._number:
                    text = self._news[next_ - self._number]
                    next_ += 1
                    await send(text)
                if next_ >= self._number:
                    await woken.wait()
        finally:
            self._pages.discard(woken)

    def _all(self) -> str:
        if self._written[0] != self._number:
            self._written = (self._number, _text("all", self._whole()))
        return self._written[1]


def _text(kind: str, news: dict[str, object]) -> str:
    return json.dumps({"kind": kind, **news}, separators=(",", ":"), allow_nan=False)

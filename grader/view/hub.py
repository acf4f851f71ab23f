"""What is told to all pages: written once, however many there are; who slept gets the whole, not what it missed."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

KEPT = 16
"""Messages that a slow page may be behind, half a second; then it is told the whole anew."""


class Hub:
    """News in order, each with a number. `whole` gives what a page that knows nothing must be told."""

    def __init__(self, whole: Callable[[], dict[str, object]]) -> None:
        self._whole = whole
        self._news: deque[str] = deque(maxlen=KEPT)
        self._number = 0
        """Of the next news."""
        self._written: tuple[int, str] = (-1, "")
        self._pages: set[asyncio.Event] = set()
        self.wholes = 0
        """How often a page was told the whole."""

    @property
    def pages(self) -> int:
        """How many follow and are awake."""
        return len(self._pages)

    def tell(self, kind: str, news: dict[str, object]) -> None:
        """Tell all that are awake."""
        self._number += 1
        if self._pages:
            self._news.append(_text(kind, news))
        else:
            self._news.clear()
        for page in self._pages:
            page.set()

    async def follow(self, send: Callable[[str], Awaitable[None]]) -> None:
        """Tell a page the whole, then all news, until cancelled; `send` waits while the page does not listen."""
        woken = asyncio.Event()
        self._pages.add(woken)
        try:
            next_ = -1
            while True:
                woken.clear()
                if next_ < self._number - len(self._news):
                    # Taken before it is sent: what comes meanwhile is news.
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

"""Connections to a page. Idle connections of other users of the machine do not displace the connections of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from uvicorn.protocols.http.h11_impl import H11Protocol

if TYPE_CHECKING:
    import asyncio

MOST = 200
"""If there are more connections, the oldest connection without a request is closed. Each connection needs a file."""


class Connection(H11Protocol):
    """An HTTP connection of uvicorn that closes the oldest idle connection if there are too many connections."""

    _number = 0
    """The number of this connection: a newer connection has a larger number."""

    @property
    def _waits(self) -> bool:
        """Whether no complete request is waiting for its response."""
        return self.cycle is None or self.cycle.response_complete

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Add the connection. uvicorn itself never closes a connection on which nothing arrives."""
        super().connection_made(transport)
        others = [each for each in self.connections if each is not self and not each.transport.is_closing()]
        alike = [each for each in others if isinstance(each, Connection)]
        self._number = 1 + max((each._number for each in alike), default=0)
        waiting = [each for each in alike if each._waits]
        if len(others) >= MOST and waiting:
            min(waiting, key=lambda each: each._number).transport.abort()

"""Connections to a page. Other users of the machine cannot block the page by opening idle connections."""

from __future__ import annotations

from typing import TYPE_CHECKING

from uvicorn.protocols.http.h11_impl import H11Protocol

if TYPE_CHECKING:
    import asyncio

MOST = 200
"""If there are more connections, the oldest idle connection is closed. Each connection uses a file descriptor."""


class Connection(H11Protocol):
    """An HTTP connection of uvicorn that closes the oldest idle connection if there are too many connections."""

    _number = 0
    """The number of this connection: a newer connection has a larger number."""

    @property
    def _waits(self) -> bool:
        """Whether the connection is idle: each complete request on it has got its response."""
        return self.cycle is None or self.cycle.response_complete

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Add the connection, and close the oldest idle connection if there are too many.

        uvicorn itself never closes a connection on which no request arrives.
        """
        super().connection_made(transport)
        others = [each for each in self.connections if each is not self and not each.transport.is_closing()]
        alike = [each for each in others if isinstance(each, Connection)]
        self._number = 1 + max((each._number for each in alike), default=0)
        waiting = [each for each in alike if each._waits]
        if len(others) >= MOST and waiting:
            min(waiting, key=lambda each: each._number).transport.abort()

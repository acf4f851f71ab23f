"""Open a page in the user's browser, and serve the page until Ctrl-C or until the simulator exits."""

from __future__ import annotations

import asyncio
import signal
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import uvicorn

from grader.view import browser
from grader.view.connections import MOST, Connection

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from starlette.types import ASGIApp

    from grader.view.address import Place
    from grader.view.guard import Door
    from grader.view.hub import Hub

_RECONNECTS_S = 2.0
"""The maximum time to wait for a tab from an earlier view to reconnect (s)."""
_TIMES = 20
_SETTINGS: dict[str, Any] = {
    "log_level": "warning",
    "access_log": False,
    "ws": "websockets-sansio",
    # Do not compress, since the page is on the same machine.
    "ws_per_message_deflate": False,
    "ws_max_size": 65536,
    # Do not drop a page that does not respond for 20 s, for example because the machine is busy. If its browser ends,
    # the system closes the connection.
    "ws_ping_interval": None,
    "lifespan": "off",
    # Do not trust an address that the client sends in a header.
    "proxy_headers": False,
    "timeout_graceful_shutdown": 1,
    "http": Connection,
    # Connections that are not idle are limited, too, so that they cannot use up the process's files.
    "limit_concurrency": 2 * MOST,
}


def ended_by_signals() -> asyncio.Event:
    """Return an event that is set by SIGINT, SIGTERM and SIGHUP."""
    ended = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    return ended


def in_loop(loop: asyncio.AbstractEventLoop, call: Callable[..., object], *arguments: object) -> None:
    """Call a function in the thread of the event loop. Do nothing if the loop is closed."""
    with suppress(RuntimeError):
        loop.call_soon_threadsafe(call, *arguments)


async def serve(
    place: Place, app: ASGIApp, door: Door, hub: Hub, ended: asyncio.Event, *, stays: bool, opens: bool = True
) -> bool:
    """Serve until the event `ended` is set. Return True.

    The page is opened in a browser only if `opens` is true. If opening the page fails, and `stays` is false, stop
    serving and return False immediately.
    """
    server = _Server(uvicorn.Config(app, **_SETTINGS))
    serving = asyncio.create_task(server.serve([place.listening]))
    ending = asyncio.create_task(ended.wait())
    opening = asyncio.create_task(_open(place, door, hub, opens=opens))
    try:
        opened = True
        if not stays:
            await asyncio.wait([opening, ending, serving], return_when=asyncio.FIRST_COMPLETED)
            opened = not opening.done() or opening.result()
        if opened:
            await asyncio.wait([ending, serving], return_when=asyncio.FIRST_COMPLETED)
    finally:
        server.end()
        await serving
    return opened


async def _open(place: Place, door: Door, hub: Hub, *, opens: bool) -> bool:
    """Open the page if `opens` is true, unless a tab from an earlier view reconnects. Return False on failure."""
    if not opens:
        return True
    for _ in range(_TIMES if place.before else 0):
        if hub.pages:
            return True
        await asyncio.sleep(_RECONNECTS_S / _TIMES)
    return await asyncio.to_thread(browser.open_page, replace(place.address, token=door.code()).url)


class _Server(uvicorn.Server):
    """A uvicorn server that does not handle signals, and runs until `end` is called."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self._ends = asyncio.Event()

    def end(self) -> None:
        """Make the server exit soon, without waiting for the exit."""
        self.should_exit = True
        self._ends.set()

    async def main_loop(self) -> None:
        """Wait until `end` is called.

        uvicorn's own main_loop wakes up ten times per second, which costs 0.1 % of a core while the page is idle.
        """
        await self._ends.wait()

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave the signal handlers unchanged."""
        yield

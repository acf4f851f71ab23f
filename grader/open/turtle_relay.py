"""Connect the turtle pane of a page to the view of turtlesim, so that the page uses only one address."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING

from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException
from websockets.typing import Origin

from grader.view.address import HOST

if TYPE_CHECKING:
    from starlette.websockets import WebSocket
    from websockets.asyncio.client import ClientConnection

    from grader.view.address import Address

LARGEST = 1 << 24
"""The maximum size of a message from the view (bytes). The messages with the whole state are the largest, because they
contain the whole trail and the last log messages."""


async def relay(page: WebSocket, address: Address) -> None:
    """Forward messages in both directions until one side closes. grader.view.guard has already accepted the page."""
    here = f"{HOST}:{address.port}"
    try:
        async with connect(
            f"ws://{here}/live?token={address.token}", origin=Origin(f"http://{here}"), max_size=LARGEST, proxy=None
        ) as view:
            both = [asyncio.create_task(_to_page(view, page)), asyncio.create_task(_to_view(page, view))]
            await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
            for each in both:
                each.cancel()
            await asyncio.gather(*both, return_exceptions=True)
    except (OSError, WebSocketException):
        pass
    with suppress(RuntimeError, WebSocketDisconnect):
        await page.close(1001)


async def _to_page(view: ClientConnection, page: WebSocket) -> None:
    async for message in view:
        await page.send_text(message if isinstance(message, str) else message.decode("utf-8", "replace"))


async def _to_view(page: WebSocket, view: ClientConnection) -> None:
    with suppress(WebSocketDisconnect, KeyError):
        while True:
            await view.send(await page.receive_text())

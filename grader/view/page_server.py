"""The server of the page. The server sends a few files, and has a connection to each page for updates and input."""

from __future__ import annotations

import asyncio
import json
import os
from contextlib import suppress
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any, Protocol

from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from grader.view.guard import answer_headers, refusal

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

    from grader.view.guard import Door
    from grader.view.hub import Hub

ASSETS = Path(__file__).parent / "assets"
STYLE = Path(__file__).parents[1] / "report/assets/page.css"
"""The style sheet of the reports, which this page also uses."""
HOLD_S = 0.5
"""If a page sends no message for this time (s), none of its keys counts as held. Pages send held keys repeatedly."""
_LARGEST = 10_000


class Controls(Protocol):
    """The receiver of the user's input on a page."""

    def receive(self, page: object, said: dict[str, Any]) -> bool:
        """Handle a message from this page. Return whether the user is now holding down any keys."""

    def let_go(self, page: object) -> None:
        """Handle the release of all keys on this page."""

    def gone(self, page: object) -> None:
        """Handle the closing of this page."""


def application(
    hub: Hub, controls: Controls, door: Door, title: str, *, index: str = "index.html", parts: str = ""
) -> ASGIApp:
    """Return the application, protected by the guard.

    The response for the path "/" is the template `index` in assets/, filled in with the title, the ROS domain, and
    `parts`, the CSS classes of the body.
    """
    filled = {"title": title, "domain": os.environ.get("ROS_DOMAIN_ID") or "0", "parts": parts}

    def whole(_: Request) -> Response:
        text = Template((ASSETS / index).read_text("utf-8")).substitute(filled)
        return Response(text, media_type="text/html")

    def file(request: Request) -> Response:
        name = request.path_params["name"]
        path = STYLE if name == STYLE.name else ASSETS / name
        # Only these files are served. No other path can be requested.
        if path != STYLE and path not in set(ASSETS.iterdir()):
            return PlainTextResponse("The file does not exist.", 404)
        return FileResponse(path)

    async def live(socket: WebSocket) -> None:
        shown = socket.query_params.get("token", "")
        if not door.opens(shown, socket.client):
            await socket.close(4403)
            return
        await socket.accept()
        if shown != door.token:
            # The page has connected with a code. Send the token, so that the page can also connect to the next
            # simulator.
            await socket.send_text(json.dumps({"kind": "token", "token": door.token}))
        await _Page(socket, hub, controls).run()

    routes = [Route("/", whole), Route("/{name}", file), WebSocketRoute("/live", live)]
    return Guard(Starlette(routes=routes))


class Guard:
    """Wraps an application: rejects forbidden requests, and adds security headers to the application's responses."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle an ASGI request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        why = refusal(headers, live=scope["type"] == "websocket")
        if why is not None:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 4403})
            else:
                await PlainTextResponse(why, 403)(scope, receive, send)
            return
        policy = [(name.encode(), text.encode()) for name, text in answer_headers(headers.get("host", "")).items()]

        async def with_policy(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *policy]
            await send(message)

        await self._app(scope, receive, with_policy)


class _Page:
    """An open page."""

    def __init__(self, socket: WebSocket, hub: Hub, controls: Controls) -> None:
        self._socket = socket
        self._hub = hub
        self._controls = controls
        self._following: asyncio.Task[None] | None = None
        self._holding = False

    async def run(self) -> None:
        """Serve the page until it is closed."""
        await self._wake()
        try:
            while True:
                try:
                    text = await asyncio.wait_for(self._socket.receive_text(), HOLD_S if self._holding else None)
                except asyncio.TimeoutError:
                    self._holding = False
                    self._controls.let_go(self)
                    continue
                with suppress(ValueError, TypeError, KeyError, AttributeError, RecursionError):
                    await self._hear(json.loads(text) if len(text) <= _LARGEST else {})
        except (WebSocketDisconnect, KeyError):
            pass
        finally:
            self._controls.gone(self)
            await self._sleep()

    async def _hear(self, said: dict[str, Any]) -> None:
        if "awake" in said:
            await (self._wake() if said["awake"] else self._sleep())
        else:
            self._holding = self._controls.receive(self, said)

    async def _wake(self) -> None:
        await self._sleep()
        self._following = asyncio.create_task(self._hub.follow(self._socket.send_text))

    async def _sleep(self) -> None:
        if self._following is not None:
            self._following.cancel()
            with suppress(asyncio.CancelledError, Exception):
                await self._following
            self._following = None

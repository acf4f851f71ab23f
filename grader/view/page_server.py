"""The server of the page. It serves a few files, and has a connection to each page for news and for input."""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from pathlib import Path
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
"""A page sends its held keys repeatedly. If no message arrives for this long, no key is considered to be held."""
_LARGEST = 10_000


class Pressed(Protocol):
    """The receiver of a page's requests."""

    def held(self, page: object, turtle: str, keys: list[str]) -> None:
        """Handle the keys that are currently held on this page."""

    def pressed(self, turtle: str, key: str) -> None:
        """Handle a key that acts once."""

    def request(self, what: str) -> None:
        """Handle a click on a button."""

    def let_go(self, page: object) -> None:
        """Handle the release of all keys on this page."""

    def gone(self, page: object) -> None:
        """Handle the closing of this page."""


def application(hub: Hub, hands: Pressed, door: Door) -> ASGIApp:
    """Return the application, protected by the guard."""

    def file(request: Request) -> Response:
        name = request.path_params.get("name", "index.html")
        path = STYLE if name == STYLE.name else ASSETS / name
        # Only these files are served. No other path can be requested.
        if path != STYLE and path not in set(ASSETS.iterdir()):
            return PlainTextResponse("There is no such file.", 404)
        return FileResponse(path)

    async def live(socket: WebSocket) -> None:
        shown = socket.query_params.get("token", "")
        if not door.opens(shown):
            await socket.close(4403)
            return
        await socket.accept()
        if shown != door.token:
            # The page connected with a code. Send it the token, so that it can also connect to the next simulator.
            await socket.send_text(json.dumps({"kind": "token", "token": door.token}))
        await _Page(socket, hub, hands).run()

    routes = [Route("/", file), Route("/{name}", file), WebSocketRoute("/live", live)]
    return _Guard(Starlette(routes=routes))


class _Guard:
    """Rejects forbidden requests, and adds the policy headers to every response."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
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
    """One open page."""

    def __init__(self, socket: WebSocket, hub: Hub, hands: Pressed) -> None:
        self._socket = socket
        self._hub = hub
        self._hands = hands
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
                    self._hands.let_go(self)
                    continue
                with suppress(ValueError, TypeError, KeyError, AttributeError):
                    await self._hear(json.loads(text) if len(text) <= _LARGEST else {})
        except (WebSocketDisconnect, KeyError):
            pass
        finally:
            self._hands.gone(self)
            await self._sleep()

    async def _hear(self, said: dict[str, Any]) -> None:
        if "held" in said:
            keys = [str(key) for key in said["held"]]
            self._holding = bool(keys)
            self._hands.held(self, str(said["turtle"]), keys)
        elif "press" in said:
            self._hands.pressed(str(said["turtle"]), str(said["press"]))
        elif "do" in said:
            self._hands.request(str(said["do"]))
        elif "awake" in said:
            await (self._wake() if said["awake"] else self._sleep())

    async def _wake(self) -> None:
        await self._sleep()
        self._following = asyncio.create_task(self._hub.follow(self._socket.send_text))

    async def _sleep(self) -> None:
        if self._following is not None:
            self._following.cancel()
            with suppress(asyncio.CancelledError, Exception):
                await self._following
            self._following = None

"""The server of the page: lessons, verdict, updates and actions, protected by grader.view.guard.

Lessons are public. A request for the learner's data must contain the token in a header, because pages of other sites
cannot send this header. The connections for updates and for the turtle have the token in their URL, and the guard
checks their Origin. For updates, a code that works only once can replace the token.
"""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass
from inspect import iscoroutinefunction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocketDisconnect

from grader.common.system_errors import refusal
from grader.common.updated import START_AGAIN, updated
from grader.errors import GraderError
from grader.open.turtle_relay import relay
from grader.view.guard import admitted
from grader.view.page_server import Guard

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from starlette.requests import Request
    from starlette.types import ASGIApp
    from starlette.websockets import WebSocket

    from grader.open.desk import Content
    from grader.open.lesson_pages import LessonPages
    from grader.view.address import Address
    from grader.view.guard import Door
    from grader.view.hub import Hub

TOKEN = "x-course-token"
"""The header with the token."""
LARGEST = 4096
"""The maximum size of the body of a request (bytes)."""
PATIENCE_S = 5.0
"""The maximum time for a page to send the body of a request (s)."""


@dataclass(frozen=True)
class DeskServer:
    """The request handlers.

    `content` returns the current data of the page. `actions` are the actions that a page can request. `turtle`
    returns the address of turtlesim's view, or None.
    """

    content: Callable[[], Content]
    hub: Hub
    door: Door
    pages: LessonPages
    actions: Mapping[str, Callable[[Mapping[str, Any]], object]]
    turtle: Callable[[], Address | None]

    def application(self) -> ASGIApp:
        """Return the application, protected by the guard."""
        routes = [
            Route("/", self._home),
            Route("/verdict", self._verdict),
            Route("/do/{name}", self._act, methods=["POST"]),
            WebSocketRoute("/live", self._live),
            WebSocketRoute("/turtle", self._turtle),
            Route("/{path:path}", self._page),
        ]
        return Guard(Starlette(routes=routes))

    async def _home(self, _: Request) -> Response:
        name = self.content().exercise
        return RedirectResponse(f"/{name}/index.html" if name else "/index.html", 307)

    async def _page(self, request: Request) -> Response:
        found = await run_in_threadpool(self.pages.find, request.path_params["path"])
        if found is None:
            return PlainTextResponse("The page does not exist.", 404)
        return FileResponse(found) if isinstance(found, Path) else Response(found, media_type="text/html")

    async def _verdict(self, request: Request) -> Response:
        if not self._admits(request):
            return _refused()
        made = self.content().verdict
        return Response(made.html if made else "", media_type="text/html")

    async def _act(self, request: Request) -> Response:
        if not self._admits(request):
            return _refused()
        action = self.actions.get(request.path_params["name"])
        if action is None:
            return JSONResponse({"problem": "The action does not exist."}, 404)
        try:
            wanted = await asyncio.wait_for(_wanted(request), PATIENCE_S)
        except asyncio.TimeoutError:
            return JSONResponse({"problem": "The request took too long."}, 408)
        except OverflowError:
            return JSONResponse({"problem": "The request is too large."}, 413)
        except (ValueError, RecursionError):
            return JSONResponse({"problem": "The request is not a JSON object."}, 400)
        try:
            made = await (action(wanted) if iscoroutinefunction(action) else run_in_threadpool(action, wanted))
        except GraderError as error:
            return JSONResponse({"problem": str(error)}, 409)
        except Exception as error:
            what = f"{type(error).__name__}: {error}".removesuffix(": ")
            fault = f"Internal error in the grader, not a problem with your work: {what}. Please report the error."
            again = START_AGAIN if await run_in_threadpool(updated) else None
            return JSONResponse({"problem": again or refusal(error) or fault}, 500)
        return JSONResponse(made)

    async def _live(self, socket: WebSocket) -> None:
        shown = socket.query_params.get("token", "")
        if not self.door.opens(shown, socket.client):
            await socket.close(4403)
            return
        await socket.accept()
        if shown != self.door.token:
            await socket.send_text(json.dumps({"kind": "token", "token": self.door.token}))
        await _follow(socket, self.hub)

    async def _turtle(self, socket: WebSocket) -> None:
        if not admitted(self.door.token, socket.query_params.get("token", "")):
            await socket.close(4403)
            return
        await socket.accept()
        address = self.turtle()
        if address is None:
            await socket.close(1001)
        else:
            await relay(socket, address)

    def _admits(self, request: Request) -> bool:
        return admitted(self.door.token, request.headers.get(TOKEN, ""))


def _refused() -> Response:
    return JSONResponse({"problem": "Open the address that grader open has printed."}, 403)


async def _wanted(request: Request) -> dict[str, Any]:
    """Return the JSON object in the body of the request.

    Raises OverflowError if the body is too large, ValueError if it is not a JSON object, or RecursionError if it is
    nested too deeply.
    """
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > LARGEST:
            raise OverflowError
    wanted = json.loads(body or b"{}")
    if not isinstance(wanted, dict):
        raise ValueError  # noqa: TRY004 - answered like text that is not JSON
    return wanted


async def _follow(socket: WebSocket, hub: Hub) -> None:
    """Send updates to a page until it is closed. A hidden page gets no updates."""
    following: asyncio.Task[None] | None = asyncio.create_task(hub.follow(socket.send_text))
    try:
        while True:
            text = await socket.receive_text()
            awake = _awake(text)
            if awake is True and following is None:
                following = asyncio.create_task(hub.follow(socket.send_text))
            elif awake is False and following is not None:
                following.cancel()
                following = None
    except (WebSocketDisconnect, KeyError):
        pass
    finally:
        if following is not None:
            following.cancel()


def _awake(text: str) -> bool | None:
    """Return True if the message reports that the page is shown, and False if it reports that the page is hidden.

    For any other message, return None.
    """
    try:
        said = json.loads(text) if len(text) <= LARGEST else {}
    except (ValueError, RecursionError):
        return None
    awake = said.get("awake") if isinstance(said, dict) else None
    return awake if isinstance(awake, bool) else None

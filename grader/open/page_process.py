"""The process that serves the page, and its connection to the process that grades.

The grading process forks to read a learner's files. A fork is safe only if no other thread is busy. Therefore, the
server is a separate process. The server receives the content of the page as lines of JSON, and sends the commands that
grading.py defines.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.learner import progress
from grader.open.actions import Actions
from grader.open.desk import Content, from_json, page_data
from grader.open.desk_server import DeskServer
from grader.open.grading import STEP
from grader.open.lesson_pages import LessonPages
from grader.open.programs import Programs
from grader.view.guard import Door
from grader.view.hub import Hub
from grader.view.serving import in_loop, serve

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable
    from pathlib import Path

    from grader.view.address import Place

LONGEST = 1 << 26
"""The maximum size of a line (bytes). The HTML of a verdict is much smaller."""
_LOOK_S = 1.0
"""The interval at which changes to the learner's progress are detected (s)."""


class PageProcess:
    """Serves the page at `place` until the grading process, at the other end of `connection`, has exited."""

    def __init__(self, connection: socket.socket, place: Place, workspace: Path | None, *, opens: bool) -> None:
        self._connection = connection
        self._place = place
        self._workspace = workspace
        self._root = progress.workspace_of(workspace)
        self._opens = opens
        self._content = Content()
        self._hub = Hub(self._data)
        self._programs = Programs(self._tell, workspace)

    async def serve(self) -> None:
        """Serve the page until the grading process has exited."""
        loop = asyncio.get_running_loop()
        # Only the grading process handles Ctrl-C. This process exits when the grading process has exited.
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, lambda: None)
        reader, writer = await asyncio.open_connection(sock=self._connection, limit=LONGEST)

        def tell(word: str) -> None:
            in_loop(loop, writer.write, f"{word}\n".encode())

        door = Door(self._place.address.token)
        requests = Actions(tell, self._workspace, self._programs, lambda: self._content.digest).all()
        pages, address = LessonPages(), self._programs.address
        app = DeskServer(lambda: self._content, self._hub, door, pages, requests, address)
        ended = asyncio.Event()
        beside = [asyncio.create_task(self._look(tell)), asyncio.create_task(self._follow(reader, ended))]
        try:
            await serve(self._place, app.application(), door, self._hub, ended, stays=True, opens=self._opens)
        finally:
            for each in beside:
                each.cancel()
            await self._programs.stop()

    async def _follow(self, reader: asyncio.StreamReader, ended: asyncio.Event) -> None:
        """Show each update of the page's content until the grading process has exited."""
        try:
            with suppress(ConnectionError):
                while line := await reader.readline():
                    self._content = from_json(line)
                    self._tell()
        finally:
            ended.set()

    async def _look(self, tell: Callable[[str], None]) -> None:
        """Detect changes to the learner's progress that were made by a page or by a command such as `grader start`."""
        before = _stamp()
        while True:
            await asyncio.sleep(_LOOK_S)
            now = _stamp()
            if now != before:
                before = now
                self._tell()
                tell(STEP)

    def _data(self) -> dict[str, object]:
        now = self._content
        return {**page_data(now, self._root), "programs": self._programs.data(now.exercise, now.digest)}

    def _tell(self) -> None:
        if self._hub.pages:
            self._hub.tell("state", self._data())
        else:
            self._hub.tell("state", {})


def _stamp() -> int:
    try:
        return progress.state_file().stat().st_mtime_ns
    except OSError:
        return 0


def main() -> None:
    """Run the process that `course_page.py` starts."""
    import socket
    import sys
    from pathlib import Path

    from grader.view.address import Address, Place

    given = json.loads(sys.argv[1])
    listening = socket.socket(fileno=given["listening"])
    # The token comes from the environment, because all users can see the arguments of a process.
    address = Address(listening.getsockname()[1], os.environ.pop("GRADER_VIEW_TOKEN"))
    workspace = Path(given["workspace"]) if given["workspace"] else None
    connection = socket.socket(fileno=given["connection"])
    place = Place(address, listening, given["before"])
    asyncio.run(PageProcess(connection, place, workspace, opens=given["opens"]).serve())

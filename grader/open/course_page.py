"""Run `grader open`: choose the address, start the process that serves the page, and grade in this process."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
from contextlib import closing, contextmanager, suppress
from threading import Thread
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.learner import progress
from grader.learner.watch import Events
from grader.open import grading
from grader.open.desk import Content, Desk, page_data, to_json
from grader.view.address import listen
from grader.view.launch import see_that_it_can_be_served

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path
    from types import FrameType

    from grader.view.address import Place

_ENDS_S = 15.0
"""The maximum time for the server to exit (s). After this time, the server is killed."""


def run(workspace: Path | None, port: int | None, *, opens: bool) -> None:
    """Serve the page and grade, until Ctrl-C or SIGTERM is received, or the terminal is closed.

    Raises:
        UsageError: `port` is not available, for example because another program is using it.
        MachineError: a library that the page needs is not installed, the learner's progress cannot be read, or the
            server has exited.
    """
    see_that_it_can_be_served("`grader watch` works without a page")
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _interrupt)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # If the progress cannot be read, report this here rather than in the page.
    page_data(Content(), progress.workspace_of(workspace))
    place = listen("open", port)
    try:
        with (
            place.listening,
            closing(Events(None)) as events,
            _page(place, workspace, opens=opens) as connection,
        ):
            print(f"Open the course at {place.address.url}", flush=True)
            for line in elsewhere(place.address.port, os.environ):
                print(line, flush=True)
            print("Press Ctrl-C to stop serving the page.", flush=True)
            Thread(target=_pass_on, args=(connection, events), daemon=True).start()
            with suppress(ConnectionError):
                grading.run(Desk(lambda content: _send(connection, content)), events, workspace)
            message = "The process that serves the page has exited. Run the command again."
            raise MachineError(message)
    except KeyboardInterrupt:
        print()


@contextmanager
def _page(place: Place, workspace: Path | None, *, opens: bool) -> Iterator[socket.socket]:
    """Start the process that serves the page, and yield a connection to that process.

    Closing the connection stops the process.
    """
    ours, theirs = socket.socketpair()
    with ours, theirs:
        given = {
            "connection": theirs.fileno(),
            "listening": place.listening.fileno(),
            "before": place.before,
            "workspace": str(workspace.absolute()) if workspace else None,
            "opens": opens,
        }
        start = interpreter(
            "-m",
            "grader.open",
            json.dumps(given),
            env={**os.environ, "GRADER_VIEW_TOKEN": place.address.token},
            searches=True,
        )
        process = subprocess.Popen(
            start.argv,
            env=start.env,
            pass_fds=[theirs.fileno(), place.listening.fileno()],
            stdin=subprocess.DEVNULL,
            # Only this process handles Ctrl-C.
            start_new_session=True,
        )
        theirs.close()
        place.listening.close()
        try:
            yield ours
        finally:
            with suppress(OSError):
                ours.shutdown(socket.SHUT_RDWR)
            try:
                process.wait(_ENDS_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _send(connection: socket.socket, content: Content) -> None:
    connection.sendall(f"{to_json(content)}\n".encode())


def _pass_on(connection: socket.socket, events: Events) -> None:
    """Add each command from the page to the events. Close the events when the server has exited."""
    with suppress(OSError), connection.makefile("r", encoding="utf-8") as lines:
        for line in lines:
            events.press(line.strip())
    events.close()


def elsewhere(port: int, env: Mapping[str, str]) -> list[str]:
    """Return a line with the command that makes the page available on another computer.

    Outside a Codespace and an ssh session, return no line.
    """
    if env.get("CODESPACES") == "true":
        name = env.get("CODESPACE_NAME", "NAME")
        return [f"On your own computer, first type: gh codespace ports forward {port}:{port} --codespace {name}"]
    if "SSH_CONNECTION" in env:
        server = (env["SSH_CONNECTION"].split()[2:3] or ["HOST"])[0]
        forward = f"{port}:127.0.0.1:{port}"
        return [f"On your own computer, first type: ssh -N -L {forward} {xdg.user_name()}@{server}"]
    return []


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt

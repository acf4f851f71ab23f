"""Start the view of a simulator in a separate process, so that no page can delay the turtle."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import termios
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from typing import TYPE_CHECKING, Literal

from grader.common.interpreter import interpreter
from grader.common.words import a_list
from grader.errors import MachineError, UsageError
from grader.view.address import listen
from grader.view.feed import Feed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.common.interpreter import Start
    from grader.turtlesim.node import TurtlesimNode

Kind = Literal["page", "terminal"]
_SERVED_WITH = ("starlette", "uvicorn", "websockets")
_WITHOUT_COLOURS = ("", "dumb", "unknown")
"""The values of TERM for terminals without colours."""
_ENDS_S = 5.0
"""The maximum time for a view to exit after its socket has been closed (s). After this time, the view is killed."""


class View:
    """A running view. `paused` is True while the simulator is paused, and `open` is True while the view is running."""

    def __init__(self, kind: Kind, feed: Feed) -> None:
        self.kind = kind
        self.feed = feed
        self.paused = False
        self.open = True

    def after_frame(self, node: TurtlesimNode) -> None:
        """Send the state to the view, and handle its requests."""
        self.feed.show(node.world.turtles, paused=self.paused)
        try:
            for wanted in self.feed.requests():
                self._do(wanted, node)
        except ConnectionError:
            self.open = False
            self.paused = False

    def _do(self, wanted: str, node: TurtlesimNode) -> None:
        if wanted == "clear":
            node.clear()
        elif wanted == "reset":
            node.reset()
        elif wanted in ("pause", "resume") and self.paused != (wanted == "pause"):
            self.paused = wanted == "pause"
            node.get_logger().info(
                "Paused in the view: the turtles do not move or publish their poses." if self.paused else "Resumed."
            )


def see_that_it_can_be_served(instead: str = "") -> None:
    """Raise MachineError if a library for the page is not installed. `instead` describes an alternative, if any."""
    missing = [name for name in _SERVED_WITH if find_spec(name) is None]
    if missing:
        message = (
            f"the page needs {a_list(missing)}, which this Python does not have. `make demo` in the "
            f"course's folder installs what is missing{f'; {instead}' if instead else ''}."
        )
        raise MachineError(message)


@contextmanager
def view(kind: Kind, port: int | None = None) -> Iterator[View]:
    """Start a view. Stop the view when the context exits.

    Raises:
        UsageError: the port is not available, or no terminal with colours is available.
        MachineError: a library that the view needs is not installed.
    """
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours, theirs:
        shown = _page(theirs, port) if kind == "page" else _terminal(theirs)
        with shown as process:
            theirs.close()
            try:
                yield View(kind, Feed(ours))
            finally:
                # The view exits when this socket is closed, which happens at the latest when the simulator exits.
                ours.close()
                try:
                    process.wait(_ENDS_S)
                except subprocess.TimeoutExpired:
                    process.kill()


@contextmanager
def _page(feed: socket.socket, port: int | None) -> Iterator[subprocess.Popen[bytes]]:
    see_that_it_can_be_served("--view terminal works without a page")
    place = listen("turtlesim", port)
    with place.listening as listening:
        given = ["--feed", str(feed.fileno()), "--listen", str(listening.fileno())]
        before = ["--before"] if place.before else []
        # Pass the token through the environment, because all users can see the arguments of a process.
        start = _start("page", *given, *before, GRADER_VIEW_TOKEN=place.address.token)
        with subprocess.Popen(
            start.argv,
            pass_fds=[feed.fileno(), listening.fileno()],
            env=start.env,
            stdin=subprocess.DEVNULL,
            # Only the simulator handles Ctrl-C. The view exits when the simulator exits.
            start_new_session=True,
        ) as process:
            listening.close()
            print(f"See the turtle move: {place.address.url}", flush=True)
            yield process


@contextmanager
def _terminal(feed: socket.socket) -> Iterator[subprocess.Popen[bytes]]:
    """Start a view in this terminal. The simulator's output goes to the view, which shows it."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        message = (
            "--view terminal needs a terminal for drawing and for reading keys, but standard input or standard output "
            "is not a terminal. It may be a pipe or a file."
        )
        raise UsageError(message)
    name = os.environ.get("TERM", "")
    if name in _WITHOUT_COLOURS:
        message = f"--view terminal needs colours, but this terminal (TERM={name}) has none."
        raise UsageError(message)
    before = termios.tcgetattr(sys.stdin.fileno())
    reading, writing = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [(number, os.dup(number)) for number in (1, 2)]
    try:
        start = _start("terminal", "--feed", str(feed.fileno()), "--said", str(reading))
        process = subprocess.Popen(start.argv, env=start.env, pass_fds=[feed.fileno(), reading])
        os.close(reading)
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        yield process
    finally:
        for number, was in kept:
            os.dup2(was, number)
            os.close(was)
        os.close(writing)
        with suppress(termios.error):
            # Restore the settings of the terminal even if the view has crashed.
            termios.tcsetattr(sys.stdin.fileno(), termios.TCSADRAIN, before)


def _start(kind: Kind, *arguments: str, **more: str) -> Start:
    return interpreter("-m", "grader.view", kind, *arguments, env={**os.environ, **more}, searches=True)

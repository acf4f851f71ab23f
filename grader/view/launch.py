"""The view of a simulator as the simulator sees it: a process of its own, so that no page can make the turtle late."""

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
"""Values of TERM."""
_ENDS_S = 5.0
"""A view that has not ended by then, after its simulator, is killed."""


class View:
    """A view that runs. `paused`: somebody has stopped the turtles' time. `open`: it is still there."""

    def __init__(self, kind: Kind, feed: Feed) -> None:
        self.kind = kind
        self.feed = feed
        self.paused = False
        self.open = True

    def after_frame(self, node: TurtlesimNode) -> None:
        """Tell the view how things stand, and do what it asks for."""
        self.feed.show(node.world.turtles, paused=self.paused)
        try:
            for wanted in self.feed.asked():
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
                "Paused in the view: no turtle moves, no pose is published." if self.paused else "Going on."
            )


def see_that_it_can_be_served() -> None:
    """Raise MachineError where what a page is served with is not installed."""
    missing = [name for name in _SERVED_WITH if find_spec(name) is None]
    if missing:
        message = (
            f"the page is served with {', '.join(missing)}, which this Python does not have. `make demo` in the "
            "course's folder installs it; --view terminal works without."
        )
        raise MachineError(message)


@contextmanager
def view(kind: Kind, port: int | None = None) -> Iterator[View]:
    """Start a view, and end it.

    Raises:
        UsageError: the port cannot be had, or there is no terminal to draw in.
        MachineError: what it needs is not installed.
    """
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours, theirs:
        shown = _page(theirs, port) if kind == "page" else _terminal(theirs)
        with shown as process:
            theirs.close()
            try:
                yield View(kind, Feed(ours))
            finally:
                # What it waits for: the end of the simulator.
                ours.close()
                try:
                    process.wait(_ENDS_S)
                except subprocess.TimeoutExpired:
                    process.kill()


@contextmanager
def _page(feed: socket.socket, port: int | None) -> Iterator[subprocess.Popen[bytes]]:
    see_that_it_can_be_served()
    place = listen("turtlesim", port)
    with place.listening as listening:
        given = ["--feed", str(feed.fileno()), "--listen", str(listening.fileno())]
        before = ["--before"] if place.before else []
        # The token is for nobody else's eyes, and arguments can be seen by all.
        start = _start("page", *given, *before, GRADER_VIEW_TOKEN=place.address.token)
        with subprocess.Popen(
            start.argv,
            pass_fds=[feed.fileno(), listening.fileno()],
            env=start.env,
            stdin=subprocess.DEVNULL,
            # Ctrl-C is for the simulator; the view ends with it.
            start_new_session=True,
        ) as process:
            listening.close()
            print(f"See it move: {place.address.url}", flush=True)
            yield process


@contextmanager
def _terminal(feed: socket.socket) -> Iterator[subprocess.Popen[bytes]]:
    """The terminal belongs to the view; what the simulator says goes there to be shown."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        message = (
            "--view terminal draws in a terminal and reads its keys, and here standard input or output is none (a "
            "pipe, a file, or it was started in the background)."
        )
        raise UsageError(message)
    name = os.environ.get("TERM", "")
    if name in _WITHOUT_COLOURS:
        message = f"--view terminal draws in colours, and this terminal (TERM={name}) has none."
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
            # Whatever happened to the view.
            termios.tcsetattr(sys.stdin.fileno(), termios.TCSADRAIN, before)


def _start(kind: Kind, *arguments: str, **more: str) -> Start:
    return interpreter("-m", "grader.view", kind, *arguments, env={**os.environ, **more}, searches=True)

"""The messages between a simulator and its view: small JSON messages over a socket.

The simulator never waits for the view. Data that cannot be sent now is sent with a later frame. If the trail
has become too long in the meantime, an image of the trail is sent.
"""

from __future__ import annotations

import base64
import io
import json
import math
import select
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from grader.turtlesim.canvas import Canvas

if TYPE_CHECKING:
    import socket
    from collections.abc import Mapping

    from grader.turtlesim.turtle import Pen, Turtle

EVERY_FRAMES = 2
"""The number of frames between messages while something is changing, for about 31 messages per second."""
SENT_EVERY_S = 0.25
"""The interval between messages while nothing is changing (s). A view needs these messages to update the rates of
topics and the age of the last command."""
MOST_LINES = 1500
"""The maximum number of drawn lines in a message. With about 90 bytes per line, the message fits into a socket buffer.
"""
MOST_RECEIVED, MOST_SENT = 64, 200
"""The maximum number of topics with commands, and of topics with published messages, in one message to the view. These
are enough for 64 turtles. However, a node can spawn and kill turtles without end while the view is busy, and each name
can have 240 characters."""
LARGEST = 1 << 20
"""The buffer size for receiving a message (bytes). No message is larger."""
LARGEST_PICTURE = 100_000
"""The maximum size of an image (bytes). The message must fit into the buffer of a socket (212,992 by default)."""

Line = tuple[float, float, float, float, int, int, int, int]
"""A line: x and y of the start, x and y of the end (m), red, green, blue, and the width in pixels."""


class WatchedCanvas(Canvas):
    """A canvas that records the lines drawn since the last message."""

    def clear(self) -> None:
        """Clear the trail."""
        super().clear()
        self.lines: list[Line] = []
        self.cleared = True

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        """Draw a line, and record it."""
        super().line(x0, y0, x1, y1, pen)
        if all(map(math.isfinite, (x0, y0, x1, y1))):
            self.lines.append((x0, y0, x1, y1, *pen.color, pen.width))


@dataclass
class Received:
    """The commands on a topic since the last message to the view: their number, and the last one with its time (s)."""

    count: int = 0
    last_s: float = 0.0
    twist: tuple[float, ...] = ()


@dataclass
class Feed:
    """The simulator's end of the socket, with callbacks for `TurtlesimNode`."""

    channel: socket.socket
    namespace: str = "/"
    """The namespace of the node. In the namespace "/", commands for turtle1 arrive on /turtle1/cmd_vel."""
    canvas: WatchedCanvas = field(default_factory=WatchedCanvas)
    received: dict[str, Received] = field(default_factory=dict)
    sent: dict[str, int] = field(default_factory=dict)
    _frames: int = 0
    _shown: object = None
    _reported_s: float = -math.inf
    _too_long: bool = False

    def __post_init__(self) -> None:
        self.channel.settimeout(0.0)

    def on_command(self, topic: str, _: bytes, twist: Any) -> None:  # noqa: ANN401 - a message of rclpy's
        """Record a received command."""
        if len(self.received) >= MOST_RECEIVED and topic not in self.received:
            return
        received = self.received.setdefault(topic, Received())
        received.count += 1
        received.last_s = time.monotonic()
        linear, angular = twist.linear, twist.angular
        received.twist = (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)

    def on_publish(self, topic: str, _: str, __: bytes) -> None:
        """Count a published message."""
        if len(self.sent) < MOST_SENT or topic in self.sent:
            self.sent[topic] = self.sent.get(topic, 0) + 1

    def show(self, turtles: Mapping[str, Turtle], *, paused: bool) -> None:
        """After a frame, send the state to the view if a message is due."""
        self._frames += 1
        if self._frames % EVERY_FRAMES:
            return
        now = time.monotonic()
        state = {
            "paused": paused,
            "namespace": self.namespace,
            "background": self.canvas.background,
            "turtles": {name: _reported(turtle) for name, turtle in turtles.items()},
        }
        changed = bool(self.canvas.lines) or self.canvas.cleared or bool(self.received) or state != self._shown
        if (changed or now - self._reported_s >= SENT_EVERY_S) and self._view_listens():
            self._tell(state, now)

    def _view_listens(self) -> bool:
        return bool(select.select([], [self.channel], [], 0)[1])

    def _tell(self, state: dict[str, object], now: float) -> None:
        canvas = self.canvas
        if len(canvas.lines) > MOST_LINES:
            # The view is too slow. Send an image of the whole trail instead.
            canvas.lines.clear()
            self._too_long = True
        message = {
            **state,
            "t": now,
            "cleared": canvas.cleared,
            "lines": canvas.lines,
            "picture": _picture(canvas) if self._too_long else None,
            "received": {topic: (each.count, each.last_s, each.twist) for topic, each in self.received.items()},
            "sent": self.sent,
        }
        try:
            self.channel.send(json.dumps(message, separators=(",", ":")).encode())
        except (BlockingIOError, ConnectionError):
            # `requests` detects whether the view has exited, with or without having read everything.
            return
        self._shown, self._reported_s = state, now
        canvas.lines, canvas.cleared, self._too_long = [], False, False
        self.received, self.sent = {}, {}

    def requests(self) -> list[str]:
        """Return the requests of the view, each of which is "pause", "resume", "clear" or "reset".

        Raises:
            ConnectionError: the view has exited.
        """
        wanted: list[str] = []
        while True:
            try:
                data = self.channel.recv(LARGEST)
            except BlockingIOError:
                return wanted
            if not data:
                message = "the view has closed the socket"
                raise ConnectionResetError(message)
            wanted.append(str(json.loads(data)))


def _reported(turtle: Turtle) -> tuple[object, ...]:
    """Return x, y (m), theta (rad), linear (m/s) and angular (rad/s), and the colour, width and state of the pen."""
    state, pen = turtle.state(), turtle.pen
    return (state.x, state.y, state.theta, state.linear, state.angular, *pen.color, pen.width, pen.down)


def _picture(canvas: Canvas) -> str:
    """Return the trail as a PNG image in base64. Pixels that were not drawn are transparent."""
    trail = canvas.trail()
    while True:
        file = io.BytesIO()
        trail.save(file, format="PNG")
        if file.tell() <= LARGEST_PICTURE:
            return base64.b64encode(file.getvalue()).decode()
        # An image with many details may be too large, so reduce its resolution.
        trail = trail.resize((trail.width // 2, trail.height // 2))

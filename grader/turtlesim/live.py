"""`python -m grader.turtlesim.live`: run turtlesim in wall time, and send pictures to another process.

The program writes each new picture to standard output: four bytes with the length (big endian), followed by a PNG
image. A slow reader misses some pictures, but gets the last picture if it reads within 2 s of the end. The program
exits when standard input is closed, when the reader has exited, or after SIGINT or SIGTERM.
"""

from __future__ import annotations

import io
import math
import os
import signal
import struct
import sys
import threading
from typing import TYPE_CHECKING

import rclpy
from PIL import Image, ImageDraw
from rclpy.signals import SignalHandlerOptions

from grader.turtlesim.node import TurtlesimNode
from grader.turtlesim.standalone import spin
from grader.turtlesim.turtle import PIXELS_PER_M, SIDE_PX

if TYPE_CHECKING:
    from grader.turtlesim.world import World

EVERY = 12
"""The number of frames per picture: at most about 5 pictures per second. A picture is not sent if nothing changed."""
SIZE_PX = 330
TURTLE: tuple[int, int, int] = (124, 197, 118)


def main() -> int:
    """Run the simulator, and return the exit code."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    threading.Thread(target=_wait_for_end, args=(stop,), daemon=True).start()
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    node = _ShownNode()
    node.screen = screen = _Screen(node.world, stop)
    spin(node, stop)
    screen.close()
    rclpy.try_shutdown()
    return 0


def _wait_for_end(stop: threading.Event) -> None:
    while os.read(0, 4096):
        pass
    stop.set()


class _ShownNode(TurtlesimNode):
    """A turtlesim node that calls `screen.after_frame` after each frame."""

    screen: _Screen | None = None

    def frame(self, now_s: float) -> None:
        super().frame(now_s)
        if self.screen is not None:
            self.screen.after_frame()


class _Screen:
    """Writes pictures in a separate thread, so that a slow reader never delays a turtle.

    If the reader has exited, `stop` is set.
    """

    def __init__(self, world: World, stop: threading.Event) -> None:
        self._world = world
        self._stop = stop
        self._frames = 0
        self._shown: object = None
        self._next: Image.Image | None = None
        self._ready = threading.Condition()
        self._closed = False
        self._thread = threading.Thread(target=self._write, daemon=True)
        self._thread.start()

    def after_frame(self) -> None:
        if self._frames % EVERY == 0:
            self._show()
        self._frames += 1

    def close(self) -> None:
        """Write the last picture, and wait up to 2 s for the reader to read it."""
        self._show()
        with self._ready:
            self._closed = True
            self._ready.notify()
        self._thread.join(2.0)

    def _show(self) -> None:
        state = [(name, turtle.x, turtle.y, turtle.theta) for name, turtle in self._world.turtles.items()]
        # Clearing the canvas replaces its image, even if no turtle has moved.
        shown = (state, self._world.canvas.background, self._world.canvas.trail())
        if shown == self._shown:
            return
        self._shown = shown
        picture = self._world.canvas.image()
        draw = ImageDraw.Draw(picture)
        for _, x, y, theta in state:
            _draw_turtle(draw, x, y, theta)
        with self._ready:
            self._next = picture
            self._ready.notify()

    def _write(self) -> None:
        while True:
            with self._ready:
                while self._next is None and not self._closed:
                    self._ready.wait()
                picture, self._next = self._next, None
            if picture is None:
                return
            data = io.BytesIO()
            picture.resize((SIZE_PX, SIZE_PX), Image.Resampling.LANCZOS).quantize(32).save(data, "PNG")
            try:
                sys.stdout.buffer.write(struct.pack(">I", data.tell()) + data.getvalue())
                sys.stdout.buffer.flush()
            except OSError:
                self._stop.set()
                return


def _draw_turtle(draw: ImageDraw.ImageDraw, x: float, y: float, theta: float) -> None:
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(theta)):
        return
    column, row = x * PIXELS_PER_M, SIDE_PX - 1 - y * PIXELS_PER_M

    def at(ahead: float, left: float) -> tuple[float, float]:
        return (
            column + ahead * math.cos(theta) - left * math.sin(theta),
            row - ahead * math.sin(theta) - left * math.cos(theta),
        )

    for ahead, left, radius in ((20, 0, 7), (11, 12, 6), (11, -12, 6), (-11, 12, 6), (-11, -12, 6)):
        centre = at(ahead, left)
        draw.ellipse([(c - radius) for c in centre] + [(c + radius) for c in centre], fill=TURTLE)
    shell = [at(17 * math.cos(a), 14 * math.sin(a)) for a in (k * math.pi / 12 for k in range(24))]
    draw.polygon(shell, fill=(47, 125, 50), outline=(255, 255, 255))


if __name__ == "__main__":
    sys.exit(main())

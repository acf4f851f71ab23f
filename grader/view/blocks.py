"""The canvas as characters. Each character is a half block that shows two square pixels."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw
from rich.color import Color
from rich.segment import Segment
from rich.style import Style

from grader.turtlesim.turtle import PIXELS_PER_M, SIDE_M, SIDE_PX
from grader.view.trail import paint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import Console, ConsoleOptions, RenderResult

    from grader.view.state import State
    from grader.view.trail import Stroke

FINER = 4
"""The factor by which the canvas is drawn larger before it is scaled down, which makes the edges smooth."""
_TURTLE_PX = 11
"""The minimum length of a turtle (pixels of the terminal). On a shorter turtle, its direction would not be visible."""
_SHELL, _SKIN, _EDGE = (47, 125, 50), (124, 197, 118), (255, 255, 255)

Rgb = tuple[int, int, int]


class Picture:
    """The canvas of a terminal, with an image of the trail. `begin` paints the whole trail, and `add` its new parts.

    `begin` is called only if the trail is cleared or replaced by an image, or if the size changes.
    """

    def __init__(self, side: int) -> None:
        """Create the image.

        `side` is in pixels of the terminal, so the image has `side` columns and half as many rows.
        """
        self.side = side
        self._trail = Image.new("RGBA", (side * FINER, side * FINER))

    def begin(self, state: State) -> None:
        """Paint the whole trail."""
        self._trail = state.trail.painted(self.side * FINER, FINER)

    def add(self, pieces: list[Stroke]) -> None:
        """Paint the new part of the trail."""
        paint(self._trail, pieces, self.side * FINER / SIDE_PX, FINER)

    def of(self, state: State) -> Image.Image:
        """Return the canvas with its turtles as an RGB image, `side` pixels wide and high."""
        picture = Image.new("RGB", self._trail.size, state.background)
        picture.paste(self._trail, mask=self._trail)
        draw = ImageDraw.Draw(picture)
        for turtle in state.turtles.values():
            if math.isfinite(turtle.x) and math.isfinite(turtle.y) and math.isfinite(turtle.theta):
                _draw_turtle(draw, turtle.x, turtle.y, turtle.theta, picture.width)
        return picture.resize((self.side, self.side), Image.Resampling.BOX)


def _draw_turtle(draw: ImageDraw.ImageDraw, x: float, y: float, theta: float, side: int) -> None:
    scale = side / SIDE_PX
    size = max(PIXELS_PER_M * scale, _TURTLE_PX * FINER) / 10
    centre_x, centre_y = x * PIXELS_PER_M * scale, (SIDE_M - y) * PIXELS_PER_M * scale
    cos, sin = math.cos(theta), math.sin(theta)

    def blob(forward: float, left: float, radius: float, color: Rgb) -> None:
        at_x = centre_x + (forward * cos - left * sin) * size
        at_y = centre_y - (forward * sin + left * cos) * size
        r = radius * size
        draw.ellipse((at_x - r, at_y - r, at_x + r, at_y + r), color)

    for forward, left in ((-2.4, 2.8), (-2.4, -2.8), (2.2, 2.8), (2.2, -2.8)):
        blob(forward, left, 1.3, _SKIN)
    blob(0.0, 0.0, 3.7, _EDGE)
    blob(0.0, 0.0, 3.1, _SHELL)
    blob(4.6, 0.0, 1.9, _SKIN)


class Blocks:
    """A picture that the library rich can print."""

    def __init__(self, picture: Image.Image) -> None:
        self._picture = picture

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield rows of half blocks, with a new segment wherever the colours change."""
        width, height = self._picture.size
        pixels: list[Rgb] = list(self._picture.getdata())
        for row in range(0, height - 1, 2):
            above, below = pixels[row * width : (row + 1) * width], pixels[(row + 1) * width : (row + 2) * width]
            yield from _row(above, below)
            yield Segment.line()


def _row(above: list[Rgb], below: list[Rgb]) -> Iterator[Segment]:
    begin = 0
    for column in range(1, len(above) + 1):
        ends = column == len(above)
        if ends or above[column] != above[begin] or below[column] != below[begin]:
            yield Segment("▀" * (column - begin), _style(above[begin], below[begin]))
            begin = column


@lru_cache(maxsize=4096)
def _style(above: Rgb, below: Rgb) -> Style:
    return Style(color=Color.from_rgb(*above), bgcolor=Color.from_rgb(*below))

"""The canvas of 500 x 500 px on which the pens of the turtles draw their trails.

Pixel (0, 0) is the upper left corner. A turtle at (x, y) m is at pixel (45 x, 499 - 45 y).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from PIL import Image, ImageDraw

from grader.turtlesim.turtle import PIXELS_PER_M, SIDE_M, SIDE_PX, Pen, Rgb

if TYPE_CHECKING:
    from pathlib import Path

BACKGROUND: Rgb = (69, 86, 255)

# Coordinates (px) are limited to this value. It is large enough to preserve the direction of the visible part of a
# line, and small enough for Pillow's integers.
_FAR_PX = 100_000.0


class Canvas:
    """The trail and the background. A new background colour does not affect the trail."""

    def __init__(self, background: Rgb = BACKGROUND) -> None:
        self.background = background
        self.clear()

    def clear(self) -> None:
        """Clear the trail."""
        # The image is transparent at first. Lines are not blended, so a new line replaces the pixels below it.
        self._image = Image.new("RGBA", (SIDE_PX, SIDE_PX), (0, 0, 0, 0))
        self._draw = ImageDraw.Draw(self._image)
        self._pixels: Any = self._image.load()

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        """Draw a line with round ends between two points (m). Draw nothing if a coordinate is nan or infinite."""
        if not (math.isfinite(x0) and math.isfinite(y0) and math.isfinite(x1) and math.isfinite(y1)):
            return
        start, end = _pixel(x0, y0), _pixel(x1, y1)
        ink = (*pen.color, 255)
        if start != end:
            self._draw.line((start, end), ink, pen.width)
        # The line of one frame is only a few pixels long. Pillow's short, wide lines leave gaps at their joints. These
        # dots fill the gaps.
        self._dot(start, ink, pen.width)
        self._dot(end, ink, pen.width)

    def _dot(self, center: tuple[int, int], ink: tuple[int, int, int, int], width: int) -> None:
        if width == 1:
            self._draw.point(center, ink)
            return
        left, top = center[0] - width // 2, center[1] - width // 2
        self._draw.ellipse((left, top, left + width - 1, top + width - 1), ink)

    def color_at(self, x: float, y: float) -> Rgb:
        """Return the colour at a point (m): the colour of the trail, or else the colour of the background."""
        if not (0.0 <= x <= SIDE_M and 0.0 <= y <= SIDE_M):
            return self.background
        red, green, blue, drawn = self._pixels[_pixel(x, y)]
        return (red, green, blue) if drawn else self.background

    def trail(self) -> Image.Image:
        """Return the trail as an RGBA image that is transparent where nothing was drawn."""
        return self._image

    def image(self) -> Image.Image:
        """Return the trail and the background as an RGB image."""
        picture = Image.new("RGB", self._image.size, self.background)
        picture.paste(self._image, mask=self._image)
        return picture

    def save(self, path: Path) -> None:
        """Write the image to a PNG file."""
        self.image().save(path, format="PNG")


def _pixel(x: float, y: float) -> tuple[int, int]:
    column = round(min(max(x * PIXELS_PER_M, -_FAR_PX), _FAR_PX))
    row = round(min(max((SIDE_M - y) * PIXELS_PER_M, -_FAR_PX), _FAR_PX))
    return column, row

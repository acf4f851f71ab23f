"""Paint a scene as an image with smooth edges.

Pillow takes 0.1 s to draw the image. Matplotlib would take 0.7 s, because importing it is slow.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw

from grader.report.shapes import DEEP, LOOKS, SEA, SIDE_M, Arrow, Line, Look, Point, Ring

if TYPE_CHECKING:
    from grader.report.scene import Scene

FINE = 3
"""The canvas is first drawn enlarged by this factor and then scaled down, so that the edges are smooth."""
DASH = 0.55
"""The fraction of one dash period (a dash and its gap) that is painted."""


def paint(scene: Scene, side_px: int) -> Image.Image:
    """Return the turtle's canvas with all shapes of the scene on it."""
    canvas = _Canvas(side_px * FINE)
    for shape in scene.shapes:
        canvas.paint(shape)
    return canvas.image.resize((side_px, side_px), Image.Resampling.BOX)


class _Canvas:
    """A canvas that is being drawn. Its methods take coordinates in metres."""

    def __init__(self, side: int) -> None:
        self.image = Image.new("RGB", (side, side), SEA)
        self._draw = ImageDraw.Draw(self.image)
        self._side = side
        self._scale = side / SIDE_M

    def paint(self, shape: Line | Ring | Arrow) -> None:
        look = shape.look if isinstance(shape, Line) else LOOKS[shape.role]
        if isinstance(shape, Arrow):
            corners = [self._pixel(corner) for corner in shape.corners]
            self._draw.polygon(corners, fill=look.color, outline=DEEP, width=FINE)
        elif isinstance(shape, Ring):
            self._ring(shape, look)
        elif look.dash_m:
            self._dashed(shape, look)
        else:
            self._line(list(shape.points), look)

    def _pixel(self, point: Point) -> Point:
        return point[0] * self._scale, self._side - point[1] * self._scale

    def _line(self, points: list[Point], look: Look) -> None:
        width = max(1, round(look.width_m * self._scale))
        self._draw.line([self._pixel(point) for point in points], fill=look.color, width=width, joint="curve")

    def _dashed(self, line: Line, look: Look) -> None:
        """Draw each straight segment as dashes of about the length that `look` specifies, with a dash at both ends."""
        for (x0, y0), (x1, y1) in pairwise(line.points):
            pieces = min(max(1, round(math.hypot(x1 - x0, y1 - y0) / (look.dash_m / DASH))), 400)
            whole = pieces - 1 + DASH
            for piece in range(pieces):
                parts = (piece / whole, (piece + DASH) / whole)
                self._line([(x0 + part * (x1 - x0), y0 + part * (y1 - y0)) for part in parts], look)

    def _ring(self, ring: Ring, look: Look) -> None:
        pieces = min(max(8, round(math.pi * ring.radius / look.dash_m)), 400)
        for piece in range(pieces):
            angles = [2.0 * math.pi * (piece + part / 6 * DASH) / pieces for part in range(7)]
            (x, y), radius = ring.centre, ring.radius
            self._line([(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles], look)

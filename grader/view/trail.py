"""The trail in a view: strokes that are sharp at any size, and an image of the older trail below them.

The coordinates are integers in tenths of the canvas's pixels, with the y axis pointing down. The integers are short in
JSON and precise enough.
"""

from __future__ import annotations

import base64
import io
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw

from grader.turtlesim.turtle import PIXELS_PER_M, SIDE_M, SIDE_PX

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from grader.view.feed import Line

UNIT = 10
"""The number of units per pixel."""
FAR = 20 * SIDE_PX * UNIT
"""The largest absolute value of a coordinate. Points beyond this limit are moved to the limit."""
MOST_POINTS = 20_000
"""The maximum number of points in all strokes. If this number is exceeded, the strokes are merged into the image."""
_SCALE = 3
"""The number of pixels in the image per pixel of the canvas."""
_SLACK = 1.0
"""The maximum distance (in units) of an omitted point from the line that replaces it."""
_MOST_SKIPPED = 40

Point = tuple[int, int]


@dataclass
class Stroke:
    """A sequence of line segments, drawn with one pen (red, green, blue, width in px).

    `skipped` contains the omitted points of the last segment.
    """

    pen: tuple[int, int, int, int]
    points: list[Point]
    skipped: list[Point] = field(default_factory=list)

    def add(self, point: Point) -> None:
        """Continue the stroke to a point. Omit the last point if it is on the line to the new point."""
        if point == self.points[-1]:
            return
        if len(self.points) >= 2:
            begin, middle = self.points[-2], self.points[-1]
            passed = [*self.skipped, middle]
            if len(passed) <= _MOST_SKIPPED and all(_beside(each, begin, point) <= _SLACK for each in passed):
                self.points[-1], self.skipped = point, passed
                return
        self.points.append(point)
        self.skipped = []


def _beside(point: Point, begin: Point, end: Point) -> float:
    """Return the distance of a point from the line segment between two other points."""
    along = (end[0] - begin[0], end[1] - begin[1])
    length = math.hypot(*along)
    if length == 0:
        return math.dist(point, begin)
    share = ((point[0] - begin[0]) * along[0] + (point[1] - begin[1]) * along[1]) / length**2
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (begin[0] + share * along[0], begin[1] + share * along[1]))


class Trail:
    """All lines that have been drawn."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Clear the trail."""
        self.strokes: list[Stroke] = []
        self.picture = b""
        self._open: dict[tuple[object, ...], Stroke] = {}
        self._points = 0

    def draw(self, lines: Iterable[Line]) -> list[Stroke]:
        """Add lines, and return the lines as strokes.

        A line that starts at the end of a stroke, with the same pen, continues that stroke.
        """
        new: dict[int, Stroke] = {}
        for x0, y0, x1, y1, red, green, blue, width in lines:
            pen = (red, green, blue, width)
            stroke = self._open.pop((x0, y0, pen), None)
            if stroke is None:
                stroke = Stroke(pen, [place(x0, y0)])
                self.strokes.append(stroke)
                self._points += 1
            piece = new.setdefault(id(stroke), Stroke(pen, [stroke.points[-1]]))
            before, to = len(stroke.points), place(x1, y1)
            stroke.add(to)
            piece.points.append(to)
            self._points += len(stroke.points) - before
            self._open[x1, y1, pen] = stroke
        if len(self._open) > 4 * len(new) + 256:
            # Remove old stroke ends that have not been continued.
            self._open = dict(list(self._open.items())[-256:])
        if self._points > MOST_POINTS:
            self._flatten()
        return list(new.values())

    def take_picture(self, png: bytes) -> None:
        """Replace the trail with an image of the whole trail."""
        self.clear()
        self.picture = png

    def _flatten(self) -> None:
        file = io.BytesIO()
        self.painted(SIDE_PX * _SCALE).save(file, format="PNG")
        self.take_picture(file.getvalue())

    def painted(self, side: int, least: int = 1) -> Image.Image:
        """Return the trail as an RGBA image that is `side` pixels wide. Strokes are at least `least` pixels wide."""
        picture = Image.new("RGBA", (side, side), (0, 0, 0, 0))
        if self.picture:
            below = Image.open(io.BytesIO(self.picture)).convert("RGBA")
            picture.paste(below.resize(picture.size, Image.Resampling.BOX))
        paint(picture, self.strokes, side / SIDE_PX, least)
        return picture

    def as_message(self) -> dict[str, object]:
        """Return the whole trail for a new page."""
        return {
            "picture": base64.b64encode(self.picture).decode() if self.picture else None,
            "strokes": as_lists(self.strokes),
        }


def as_lists(strokes: Iterable[Stroke]) -> list[list[int]]:
    """Convert strokes to lists for a page: red, green, blue, width, and x, y of each point."""
    return [[*stroke.pen, *(value for point in stroke.points for value in point)] for stroke in strokes]


def place(x: float, y: float) -> Point:
    """Convert the coordinates of a point (m) to units of the trail."""
    column, row = x * PIXELS_PER_M * UNIT, (SIDE_M - y) * PIXELS_PER_M * UNIT
    return round(min(max(column, -FAR), FAR)), round(min(max(row, -FAR), FAR))


def paint(picture: Image.Image, strokes: Sequence[Stroke], scale: float, least: int = 1) -> None:
    """Paint strokes, each at least `least` pixels wide, into an image with `scale` pixels per canvas pixel."""
    draw = ImageDraw.Draw(picture)
    for stroke in strokes:
        ink = (*stroke.pen[:3], 255)
        width = max(least, round(stroke.pen[3] * scale))
        points = [(x * scale / UNIT, y * scale / UNIT) for x, y in stroke.points]
        if len(points) > 1:
            draw.line(points, ink, width, joint="curve")
        for x, y in (points[0], points[-1]):
            if width > 1:
                draw.ellipse((x - width / 2, y - width / 2, x + width / 2, y + width / 2), ink)

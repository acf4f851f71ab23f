"""One picture of a run: the turtle's canvas with its way, the circle that fits it best and the one that was asked for.

Drawn with Pillow: 0.1 s, where matplotlib needs 0.7 s, most of it for its import.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw, ImageFont

from grader.checks import seen
from grader.checks.path import CircleParams, expected_centre
from grader.errors import UsageError
from grader.outcome import Report, Status
from grader.words import printable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from grader.checks.evidence import Evidence
    from grader.checks.track import Track

Point = tuple[float, float]
Rgb = tuple[int, int, int]

SIDE_M = 499 / 45
"""turtlesim's canvas: 500 pixels, 45 a metre."""
SIDE_PX = 640
FINE = 3
"""The canvas is drawn this much larger and made smaller, for smooth edges."""
LEFT, TOP, RIGHT, BOTTOM = 64, 72, 300, 60
MOST_TICKS = 150

SEA: Rgb = (69, 86, 255)
PEN: Rgb = (179, 184, 255)
PEN_WIDTH_M = 3 / 45
FITTED: Rgb = (255, 255, 255)
EXPECTED: Rgb = (255, 214, 92)
TICK: Rgb = (16, 20, 84)
WALL: Rgb = (255, 92, 80)
PAPER: Rgb = (255, 255, 255)
INK: Rgb = (33, 37, 41)
GREY: Rgb = (92, 99, 106)
GOOD: Rgb = (24, 112, 58)
BAD: Rgb = (176, 28, 28)


@dataclass(frozen=True)
class Canvas:
    """The turtle's canvas while it is drawn, FINE times too large; takes metres."""

    image: Image.Image
    draw: ImageDraw.ImageDraw

    @classmethod
    def empty(cls) -> Canvas:
        """A canvas of water."""
        image = Image.new("RGB", (SIDE_PX * FINE, SIDE_PX * FINE), SEA)
        return cls(image, ImageDraw.Draw(image))

    def pixel(self, point: Point) -> Point:
        """Where a point (m) lies in the image."""
        scale = SIDE_PX * FINE / SIDE_M
        return point[0] * scale, SIDE_PX * FINE - point[1] * scale

    def line(self, points: Iterable[Point], color: Rgb, width_m: float) -> None:
        """A line through the points (m)."""
        width = max(1, round(width_m * SIDE_PX * FINE / SIDE_M))
        self.draw.line([self.pixel(point) for point in points], fill=color, width=width, joint="curve")

    def circle(self, centre: Point, radius: float, color: Rgb, width_m: float, dash_m: float) -> None:
        """A circle in dashes of about this length."""
        pieces = min(max(8, round(math.pi * radius / dash_m)), 400)
        for piece in range(pieces):
            angles = [2.0 * math.pi * (piece + part / 6 * 0.55) / pieces for part in range(7)]
            arc = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
            self.line(arc, color, width_m)

    def arrow(self, point: Point, theta: float, color: Rgb, size_m: float) -> None:
        """A slim triangle at the point, looking along theta (rad)."""
        corners = [(0.0, 1.0), (2.5, 0.6), (math.pi, 0.35), (-2.5, 0.6)]
        shape = [
            self.pixel((point[0] + size_m * r * math.cos(theta + a), point[1] + size_m * r * math.sin(theta + a)))
            for a, r in corners
        ]
        self.draw.polygon(shape, fill=color, outline=TICK, width=FINE)


def save_picture(evidence: Evidence, report: Report, file: Path) -> None:
    """Write the picture as a PNG file. Raises UsageError where that cannot be done."""
    image = draw_picture(evidence, report)
    try:
        image.save(file, format="PNG")
    except OSError as error:
        message = f"The picture cannot be written to {file}: {error.strerror or error}."
        raise UsageError(message) from error


def draw_picture(evidence: Evidence, report: Report) -> Image.Image:
    """The picture as an image; where there is no way to draw, it says so."""
    page = Image.new("RGB", (LEFT + SIDE_PX + RIGHT, TOP + SIDE_PX + BOTTOM), PAPER)
    canvas = Canvas.empty()
    params = _circle_params(evidence)
    legend, facts, empty = _draw_way(evidence, canvas, params)
    page.paste(canvas.image.resize((SIDE_PX, SIDE_PX), Image.Resampling.BOX), (LEFT, TOP))
    pen = ImageDraw.Draw(page)
    _axes(pen)
    _title(pen, report)
    _legend(pen, legend, facts)
    if empty:
        _middle(pen, empty)
    return page


def _circle_params(evidence: Evidence) -> CircleParams | None:
    for spec in evidence.exercise.checks:
        if spec.kind == "circle" and not spec.hidden:
            return CircleParams(**spec.params)  # type: ignore[arg-type]
    return None


Legend = list[tuple[str, str, Rgb]]
"""(sort, text, colour) with the sort "line", "dashes", "tick", "arrow" or "cross"."""


def _draw_way(evidence: Evidence, canvas: Canvas, params: CircleParams | None) -> tuple[Legend, list[str], str]:
    """Draw what the recording holds: the legend of it, the numbers, and what to say when there is no way."""
    recording = evidence.recording
    if recording is None:
        return [], [], "The node was not run."
    track = evidence.track
    legend: Legend = []
    facts: list[str] = []
    points = _finite(track)
    moved = track.finite and len(track.points[0]) > 1
    if len(points) > 1:
        canvas.line(points, PEN, PEN_WIDTH_M)
        legend.append(("line", "the turtle's way", PEN))
    start = (recording.start.x, recording.start.y)
    if params is not None:
        centre = expected_centre(recording.start, params)
        canvas.circle(centre, params.radius_m, EXPECTED, 0.045, 0.28)
        legend.append(("dashes", f"asked for: radius {params.radius_m:.2f} m", EXPECTED))
    fitted = track.circle if moved else None
    if fitted is not None and fitted.radius <= SIDE_M:
        canvas.circle((fitted.x, fitted.y), fitted.radius, FITTED, 0.028, 0.14)
        legend.append(("dashes", f"best fit: radius {fitted.radius:.2f} m", FITTED))
        facts.append(f"centre ({fitted.x:.2f}, {fitted.y:.2f}) m")
        facts.append(f"off the circle {fitted.rms:.3f} m RMS")
        facts.append(f"{abs(track.turns):.2f} turns {'counter-clockwise' if track.turns > 0 else 'clockwise'}")
    commands = evidence.commands
    ticks = [command.t_s for command in commands[:: len(commands) // MOST_TICKS + 1]]
    if moved and ticks:
        _ticks(canvas, track, ticks)
        legend.append(("tick", "a command arrives", TICK))
    if track.wall.any():
        _cross(canvas, track)
        legend.append(("cross", "touches a wall", WALL))
    canvas.arrow(start, recording.start.theta, FITTED, 0.28)
    legend.append(("arrow", "start", FITTED))
    facts.insert(0, f"{len(commands)} commands in {seen.end_s(recording):.1f} s")
    if not track.finite:
        return legend, facts, "The turtle's position became NaN (not a number)."
    return legend, facts, "" if moved else "The turtle did not move."


def _finite(track: Track) -> list[Point]:
    points: list[Point] = []
    for x, y in zip(track.x.tolist(), track.y.tolist(), strict=True):
        if not (math.isfinite(x) and math.isfinite(y)):
            break
        if not points or points[-1] != (x, y):
            points.append((x, y))
    return points


def _ticks(canvas: Canvas, track: Track, times: list[float]) -> None:
    """A short stroke across the way where the turtle was at each of these times (s)."""
    for index in track.t_s.searchsorted(times).tolist():
        at = min(index, len(track.t_s) - 1)
        x, y = float(track.x[at]), float(track.y[at])
        ahead = min(at + 1, len(track.x) - 1)
        behind = max(ahead - 2, 0)
        dx, dy = float(track.x[ahead] - track.x[behind]), float(track.y[ahead] - track.y[behind])
        length = math.hypot(dx, dy)
        if length > 0.0:
            nx, ny = -dy / length * 0.11, dx / length * 0.11
            canvas.line([(x - nx, y - ny), (x + nx, y + ny)], TICK, 0.035)


def _cross(canvas: Canvas, track: Track) -> None:
    at = int(track.wall.argmax()) + 1
    x, y = float(track.x[at]), float(track.y[at])
    if math.isfinite(x) and math.isfinite(y):
        x, y = min(max(x, 0.2), SIDE_M - 0.2), min(max(y, 0.2), SIDE_M - 0.2)
        canvas.line([(x - 0.15, y - 0.15), (x + 0.15, y + 0.15)], WALL, 0.07)
        canvas.line([(x - 0.15, y + 0.15), (x + 0.15, y - 0.15)], WALL, 0.07)


def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size)


def _axes(draw: ImageDraw.ImageDraw) -> None:
    """Metres along the left and the lower edge."""
    bottom = TOP + SIDE_PX
    font = _font(14)
    for metre in range(12):
        offset = metre * SIDE_PX / SIDE_M
        x, y = LEFT + offset, bottom - offset
        draw.line([(x, bottom), (x, bottom + 5)], fill=GREY, width=1)
        draw.line([(LEFT - 6, y), (LEFT - 1, y)], fill=GREY, width=1)
        draw.text((x, bottom + 8), str(metre), fill=GREY, font=font, anchor="ma")
        draw.text((LEFT - 10, y), str(metre), fill=GREY, font=font, anchor="rm")
    draw.text((LEFT + SIDE_PX / 2, bottom + 30), "x (m)", fill=GREY, font=font, anchor="ma")
    draw.text((14, TOP + SIDE_PX / 2), "y (m)", fill=GREY, font=font, anchor="lm")


def _title(draw: ImageDraw.ImageDraw, report: Report) -> None:
    draw.text((LEFT, 14), printable(report.exercise_title), fill=INK, font=_font(22))
    points = f"{report.points:g} of {report.max:g} points"
    errors, failed = report.with_status(Status.ERROR), report.with_status(Status.FAILED)
    if errors:
        draw.text((LEFT, 44), f"Not finished, {points}: the machine failed.", fill=BAD, font=_font(16))
    elif failed or report.with_status(Status.SKIPPED):
        first = f": {printable(failed[0].finding.seen)}" if failed and not failed[0].hidden else ""
        text = _cut(draw, f"Not passed yet, {points}{first}", SIDE_PX + RIGHT - 20)
        draw.text((LEFT, 44), text, fill=BAD, font=_font(16))
    else:
        draw.text((LEFT, 44), f"Passed, {points}", fill=GOOD, font=_font(16))


def _cut(draw: ImageDraw.ImageDraw, text: str, width: float) -> str:
    font = _font(16)
    if draw.textlength(text, font=font) <= width:
        return text
    while text and draw.textlength(f"{text}...", font=font) > width:
        text = text[:-1]
    return f"{text.rstrip()}..."


def _legend(draw: ImageDraw.ImageDraw, legend: Legend, facts: list[str]) -> None:
    """Signs on a strip of water, as they look on the canvas, each with its meaning; the numbers below."""
    x, y = LEFT + SIDE_PX + 20, TOP
    font = _font(15)
    for sort, text, color in legend:
        draw.rectangle([(x, y), (x + 46, y + 26)], fill=SEA)
        _sign(draw, sort, (x, y + 13), color)
        draw.text((x + 58, y + 13), text, fill=INK, font=font, anchor="lm")
        y += 34
    y += 8
    for fact in facts:
        draw.text((x, y), fact, fill=GREY, font=font)
        y += 24


def _sign(draw: ImageDraw.ImageDraw, sort: str, at: tuple[int, int], color: Rgb) -> None:
    x, y = at
    if sort == "line":
        draw.line([(x + 5, y), (x + 41, y)], fill=color, width=4)
    elif sort == "dashes":
        for begin in (6, 19, 32):
            draw.line([(x + begin, y), (x + begin + 8, y)], fill=color, width=3)
    elif sort == "tick":
        draw.line([(x + 5, y), (x + 41, y)], fill=PEN, width=4)
        draw.line([(x + 23, y - 7), (x + 23, y + 7)], fill=color, width=2)
    elif sort == "arrow":
        draw.polygon([(x + 34, y), (x + 14, y + 8), (x + 19, y), (x + 14, y - 8)], fill=color)
    else:
        draw.line([(x + 16, y - 7), (x + 30, y + 7)], fill=color, width=4)
        draw.line([(x + 16, y + 7), (x + 30, y - 7)], fill=color, width=4)


def _middle(draw: ImageDraw.ImageDraw, text: str) -> None:
    """A sentence across the canvas, below the start."""
    at = (LEFT + SIDE_PX / 2, TOP + SIDE_PX * 0.72)
    font = _font(20)
    left, top, right, bottom = draw.textbbox(at, text, font=font, anchor="mm")
    draw.rectangle([(left - 14, top - 10), (right + 14, bottom + 10)], fill=TICK)
    draw.text(at, text, fill=PAPER, font=font, anchor="mm")

"""A run as a PNG image: the turtle's canvas with axes, the verdict, a legend and some numbers.

Several trials appear in two columns.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw, ImageFont

from grader.checks.outcome import Status
from grader.common.words import count, printable
from grader.report.output_file import write
from grader.report.scene import Scene, executables, scene_of
from grader.report.scene_image import paint
from grader.report.shapes import DEEP, LOOKS, SEA, SIDE_M, Rgb, Role
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from grader.evidence.evidence import Evidence
    from grader.exercise.model import TrialSpec
    from grader.report.report import Report

SIDE_PX = 640
LEFT, TOP, RIGHT, BOTTOM = 64, 72, 300, 60
SMALL_PX = 420
"""The side length of each canvas (pixels) if the picture has several."""
ACROSS = 2
HEADING = 40

PAPER: Rgb = (255, 255, 255)
INK: Rgb = (33, 37, 41)
GREY: Rgb = (92, 99, 106)
GOOD: Rgb = (24, 112, 58)
BAD: Rgb = (176, 28, 28)


@dataclass(frozen=True)
class Panel:
    """The position of a canvas on the page, in pixels. The axes and the legend are drawn outside the canvas."""

    left: int
    top: int
    side: int


def save_picture(evidence: Evidence, report: Report, file: Path) -> None:
    """Write the picture as a PNG file. Raises the same errors as `output_file.write`."""
    write(file, read(_png, evidence, report))


def _png(evidence: Evidence, report: Report) -> bytes:
    image = io.BytesIO()
    draw_picture(evidence, report).save(image, format="PNG")
    return image.getvalue()


def _is_drawn(trial: TrialSpec) -> bool:
    return not trial.calls and trial.tests is None and not trial.beside


def draw_picture(evidence: Evidence, report: Report) -> Image.Image:
    """Return one image with a picture of each trial, except trials without a simulator.

    A trial whose node runs in another trial (`beside`) has no picture of its own. If there is no trajectory
    to draw, the picture shows the reason.
    """
    trials = [each for each in evidence.views() if _is_drawn(each.trial)] or [evidence]
    panels = _panels(len(trials))
    page = _page(panels)
    pen = ImageDraw.Draw(page)
    _title(pen, report, page.width)
    for panel, each in zip(panels, trials, strict=True):
        scene = scene_of(each)
        page.paste(paint(scene, panel.side), (panel.left, panel.top))
        _axes(pen, panel)
        _legend(pen, scene, panel)
        if len(trials) > 1:
            name = printable(executables(each))
            pen.text((panel.left, panel.top - HEADING / 2), name, fill=INK, font=_font(18), anchor="lm")
        if scene.notice:
            _middle(pen, scene.notice, panel)
    return page


def _panels(count: int) -> list[Panel]:
    """Return the positions and sizes of the canvases: one large canvas, or a grid of smaller ones."""
    if count == 1:
        return [Panel(LEFT, TOP, SIDE_PX)]
    wide, high = LEFT + SMALL_PX + RIGHT, HEADING + SMALL_PX + BOTTOM
    places = [divmod(index, ACROSS) for index in range(count)]
    return [Panel(LEFT + column * wide, TOP + HEADING + row * high, SMALL_PX) for row, column in places]


def _page(panels: Sequence[Panel]) -> Image.Image:
    right = max(panel.left + panel.side for panel in panels)
    bottom = max(panel.top + panel.side for panel in panels)
    return Image.new("RGB", (right + RIGHT, bottom + BOTTOM), PAPER)


def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size)


def _axes(draw: ImageDraw.ImageDraw, panel: Panel) -> None:
    """Draw the scale in metres along the left and bottom edges."""
    bottom = panel.top + panel.side
    font = _font(14)
    for metre in range(12):
        offset = metre * panel.side / SIDE_M
        x, y = panel.left + offset, bottom - offset
        draw.line([(x, bottom), (x, bottom + 5)], fill=GREY, width=1)
        draw.line([(panel.left - 6, y), (panel.left - 1, y)], fill=GREY, width=1)
        draw.text((x, bottom + 8), str(metre), fill=GREY, font=font, anchor="ma")
        draw.text((panel.left - 10, y), str(metre), fill=GREY, font=font, anchor="rm")
    draw.text((panel.left + panel.side / 2, bottom + 30), "x (m)", fill=GREY, font=font, anchor="ma")
    draw.text((panel.left - 50, panel.top + panel.side / 2), "y (m)", fill=GREY, font=font, anchor="lm")


def _title(draw: ImageDraw.ImageDraw, report: Report, width: int) -> None:
    draw.text((LEFT, 14), printable(report.exercise_title), fill=INK, font=_font(22))
    points = f"{report.points:g} of {report.max:g} points"
    errors, failed = report.with_status(Status.ERROR), report.with_status(Status.FAILED)
    if errors:
        unjudged = f"{count(len(errors), 'check')} could not be judged."
        draw.text((LEFT, 44), f"Not finished, {points}: {unjudged}", fill=BAD, font=_font(16))
    elif report.exit_code:
        first = f": {printable(failed[0].finding.observed)}" if failed and not failed[0].hidden else ""
        text = _cut(draw, f"Not passed yet, {points}{first}", width - LEFT - 20)
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


def _legend(draw: ImageDraw.ImageDraw, scene: Scene, panel: Panel) -> None:
    """Draw the legend: each symbol on the canvas's background colour, with its meaning, and the numbers below."""
    x, y = panel.left + panel.side + 20, panel.top
    font = _font(15)
    for role, text in scene.legend:
        draw.rectangle([(x, y), (x + 46, y + 26)], fill=SEA)
        _sign(draw, role, (x, y + 13))
        draw.text((x + 58, y + 13), text, fill=INK, font=font, anchor="lm")
        y += 34
    y += 8
    for fact in scene.facts:
        draw.text((x, y), fact, fill=GREY, font=font)
        y += 24


def _sign(draw: ImageDraw.ImageDraw, role: Role, at: tuple[int, int]) -> None:
    x, y = at
    color = LOOKS[role].color
    if role == "trajectory":
        draw.line([(x + 5, y), (x + 41, y)], fill=color, width=4)
    elif role == "other":
        draw.line([(x + 5, y), (x + 41, y)], fill=color, width=3)
    elif role in ("expected", "fitted"):
        for begin in (6, 19, 32):
            draw.line([(x + begin, y), (x + begin + 8, y)], fill=color, width=3)
    elif role == "tick":
        draw.line([(x + 5, y), (x + 41, y)], fill=LOOKS["trajectory"].color, width=4)
        draw.line([(x + 23, y - 7), (x + 23, y + 7)], fill=color, width=2)
    elif role == "start":
        draw.polygon([(x + 34, y), (x + 14, y + 8), (x + 19, y), (x + 14, y - 8)], fill=color)
    else:
        draw.line([(x + 16, y - 7), (x + 30, y + 7)], fill=color, width=4)
        draw.line([(x + 16, y + 7), (x + 30, y - 7)], fill=color, width=4)


def _middle(draw: ImageDraw.ImageDraw, text: str, panel: Panel) -> None:
    """Write a sentence in the lower half of the canvas."""
    at = (panel.left + panel.side / 2, panel.top + panel.side * 0.72)
    font = _font(20)
    left, top, right, bottom = draw.textbbox(at, text, font=font, anchor="mm")
    draw.rectangle([(left - 14, top - 10), (right + 14, bottom + 10)], fill=DEEP)
    draw.text(at, text, fill=PAPER, font=font, anchor="mm")

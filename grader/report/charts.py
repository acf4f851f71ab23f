"""Charts over time as SVG: the intervals between commands, and the values in the commands.

All charts of a trial have the same time axis. If there are more values than a chart can show, only the lowest and the
highest value of each short period are drawn. Colour is never the only cue: a value that is not allowed is drawn as a
cross.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import count, number
from grader.evidence import activity
from grader.report.expectations import requested_interval, requested_values
from grader.report.svg import coordinate, picture, points, tag, words
from grader.trial.recording import FIELDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from grader.evidence.evidence import Evidence

WIDTH = 440.0
LEFT, RIGHT, TOP, BOTTOM = 58.0, 12.0, 24.0, 34.0
HEIGHT = 150.0
"""The height of the area inside the axes, for one row of a chart."""
GAP = 46.0
"""The space between two rows."""
BINS = 120
"""The number of bins for a long series of values. Only the lowest and the highest value of each bin are drawn."""
HUGE = 1e4
"""Before values are drawn, they are limited to the range from -HUGE to HUGE."""

DOT, BAD, BAND = "#1c7ed6", "#d6336c", "#2f9e44"
"""Colours with a contrast of at least 3:1 against both the white page and the dark page."""

Series = tuple[tuple[float, float], ...]
"""Pairs (t_s, value), sorted by time."""


@dataclass(frozen=True)
class Chart:
    """A picture, and a caption that describes its values."""

    svg: str
    caption: str


@dataclass(frozen=True)
class Area:
    """The area inside a chart's axes: time from 0 to `end_s` to the right, values from `low` to `high` upwards."""

    end_s: float
    low: float
    high: float
    top: float = TOP

    def x(self, t_s: float) -> float:
        """Return the x coordinate of a time."""
        return LEFT + (WIDTH - LEFT - RIGHT) * min(max(t_s / self.end_s, 0.0), 1.0)

    def y(self, value: float) -> float:
        """Return the y coordinate of a value."""
        return self.top + HEIGHT * (1.0 - (min(max(value, self.low), self.high) - self.low) / (self.high - self.low))

    def frame(self, label: str) -> str:
        """Draw the axes with their numbers. `label` describes the values."""
        bottom = self.top + HEIGHT
        parts = [words(label, LEFT, self.top - 8, font_weight="bold")]
        for value in ticks(self.low, self.high):
            y = self.y(value)
            line = f"M{coordinate(LEFT)} {coordinate(y)}H{coordinate(WIDTH - RIGHT)}"
            parts.append(tag("path", d=line, stroke="currentColor", stroke_opacity=0.2))
            parts.append(words(f"{value:g}", LEFT - 6, y + 4.5, "end"))
        parts += [words(f"{t_s:g}", self.x(t_s), bottom + 17, "middle") for t_s in ticks(0.0, self.end_s, 6)]
        frame = tag("rect", x=LEFT, y=self.top, width=WIDTH - LEFT - RIGHT, height=HEIGHT, fill="none")
        return tag("g", *parts, tag("g", frame, stroke="currentColor", stroke_opacity=0.6), class_="axes")

    def head(self) -> str:
        """Draw the line that shows the current time of the player."""
        bottom = coordinate(self.top + HEIGHT)
        path = f"M{coordinate(LEFT)} {coordinate(self.top)}V{bottom}"
        return tag("path", d=path, stroke="currentColor", stroke_width=1.5, visibility="hidden", class_="head")


def ticks(low: float, high: float, most: int = 5) -> list[float]:
    """Return at most `most` + 1 round numbers from low to high."""
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * nice for nice in (1.0, 2.0, 5.0, 10.0) if power * nice >= rough * 0.999)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [index * step for index in range(first, last + 1)]


def thin(series: Series, end_s: float, bins: int = BINS) -> Series:
    """Return the series, or only the lowest and the highest value of each bin if the series is long.

    Values that are not finite are omitted, and all others are limited to the range from -HUGE to HUGE.
    """
    finite = tuple((t, min(max(value, -HUGE), HUGE)) for t, value in series if math.isfinite(value))
    if len(finite) <= 2 * bins:
        return finite
    stretches: dict[int, list[tuple[float, float]]] = {}
    for t, value in finite:
        stretches.setdefault(int(t / end_s * bins), []).append((t, value))
    kept: list[tuple[float, float]] = []
    for inside in stretches.values():
        ends = {min(inside, key=lambda each: each[1]), max(inside, key=lambda each: each[1])}
        kept += sorted(ends)
    return tuple(kept)


def intervals(evidence: Evidence, name: str = "intervals", bins: int = BINS) -> Chart | None:
    """Draw the measured intervals between commands, with the allowed range if the exercise requires an interval.

    Return None if no interval was measured.
    """
    measured = evidence.command_arrivals
    if not measured.intervals:
        return None
    wanted = requested_interval(evidence)
    end_s = _end_s(evidence)
    pairs = zip(measured.begins, measured.intervals, strict=True)
    series: Series = tuple((begin + interval, interval) for begin, interval in pairs)
    stalled = len(measured.arrivals) - 1 - len(series)
    low_s, high_s = (wanted.low_s, wanted.high_s) if wanted else (0.0, math.inf)
    middle_s = wanted.requested_s if wanted else measured.mean_s
    top = max(1.25 * middle_s, 1.1 * max(measured.intervals), 1.15 * wanted.high_s if wanted else 0.0)
    area = Area(end_s, 0.0, max(top, 1e-3))
    low, high = min(measured.intervals), max(measured.intervals)
    caption = f"{count(len(series), 'interval')}, {_s(measured.mean_s)} s on average, from {_s(low)} to {_s(high)} s."
    if stalled:
        others, them = ("1 interval is", "it") if stalled == 1 else (f"{stalled} intervals are", "them")
        caption += (
            f" {others} left out, because the start of the trial or a stall of the machine may have changed {them}."
        )
    drawn = ""
    if wanted:
        caption += f" Required: {middle_s:.2f} s; allowed: {low_s:.2f} to {high_s:.2f} s (the green band)."
        drawn += _band(area, low_s, high_s) + _dashes(area, middle_s)
    drawn += "".join(_dot(area, t, value, good=low_s <= value <= high_s) for t, value in thin(series, end_s, bins))
    svg = picture(
        area.frame("seconds since the previous command"),
        drawn,
        area.head(),
        words("time (s)", WIDTH - RIGHT, TOP + HEIGHT + 32, "end"),
        width=WIDTH,
        height=TOP + HEIGHT + BOTTOM,
        title="Intervals between commands over time",
        about=caption,
        key="intervals",
        name=name,
    )
    return Chart(svg, caption)


def _s(seconds: float) -> str:
    """Format a time with two decimal places, or with two significant digits if the time is below 0.1 s."""
    return f"{seconds:.2f}" if seconds >= 0.1 else f"{seconds:.2g}"


def values(evidence: Evidence, name: str = "values", bins: int = BINS) -> Chart | None:
    """Draw the values of the commands over time. Return None if there are no commands.

    The fields linear.x and angular.z always have a row. Any other field has a row only if the exercise requires a value
    other than 0, or if its value was not always 0.
    """
    commands = evidence.commands
    if not commands:
        return None
    requested = requested_values(evidence)
    wanted = requested or (0.0,) * 6
    end_s = _end_s(evidence)
    rows, captions = [], []
    shown = [i for i in range(6) if wanted[i] or i in (0, 5) or any(command.values[i] for command in commands)]
    for row, index in enumerate(shown):
        series = tuple((command.t_s, command.values[index]) for command in commands)
        unit = "m/s" if index < 3 else "rad/s"
        top = TOP + row * (HEIGHT + GAP)
        rows.append(
            _steps(series, wanted[index] if requested else None, f"{FIELDS[index]} ({unit})", end_s, (top, bins))
        )
        captions.append(_in_words(series, FIELDS[index], unit, wanted[index] if requested else None))
    height = TOP + len(shown) * HEIGHT + (len(shown) - 1) * GAP + BOTTOM
    caption = " ".join(captions)
    svg = picture(
        *rows,
        words("time (s)", WIDTH - RIGHT, height - 2, "end"),
        width=WIDTH,
        height=height,
        title="Values in the commands over time",
        about=caption,
        key="values",
        name=name,
    )
    return Chart(svg, caption)


def _end_s(evidence: Evidence) -> float:
    return max(activity.end_s(evidence.recording), 0.1)


def _steps(series: Series, wanted: float | None, label: str, end_s: float, where: tuple[float, int]) -> str:
    """Draw one field of the commands: a line that keeps each value until the next command, and any required value.

    `where` contains the y coordinate of the chart's top, and the number of bins.
    """
    top, bins = where
    drawn = thin(series, end_s, bins)
    known = [value for _, value in drawn] + ([wanted] if wanted is not None else []) + [0.0]
    low, high = min(known), max(known)
    margin = 0.15 * (high - low) or 1.0
    area = Area(end_s, low - margin, high + margin, top)
    line: list[tuple[float, float]] = []
    for index, (t, value) in enumerate(drawn):
        until = drawn[index + 1][0] if index + 1 < len(drawn) else end_s
        line += [(area.x(t), area.y(value)), (area.x(until), area.y(value))]
    parts = [area.frame(label)]
    if wanted is not None:
        parts.append(_dashes(area, wanted))
    parts.append(tag("polyline", points=points(line), fill="none", stroke=DOT, stroke_width=2))
    parts += [_dot(area, t, value, good=wanted is None or abs(value - wanted) <= 1e-6) for t, value in drawn]
    parts.append(area.head())
    return "".join(parts)


def _in_words(series: Series, field: str, unit: str, wanted: float | None) -> str:
    """Describe one field of the commands in words."""
    found = [value for _, value in series]
    wrong = sum(not math.isfinite(value) for value in found)
    finite = [value for value in found if math.isfinite(value)]
    if finite and min(finite) == max(finite):
        text = f"{field} was {number(finite[0])} {unit}"
    elif finite:
        text = f"{field} was {number(min(finite))} to {number(max(finite))} {unit}"
    else:
        text = f"{field} was never a finite number"
    if wrong and finite:
        text += f", and not a finite number in {wrong} of {len(found)} commands"
    return f"{text}; required: {number(wanted)}." if wanted is not None else f"{text}."


def _dot(area: Area, t_s: float, value: float, *, good: bool) -> str:
    x, y = area.x(t_s), area.y(value)
    if good:
        return tag("circle", cx=x, cy=y, r=3, fill=DOT)
    cross = f"M{coordinate(x - 4)} {coordinate(y - 4)}l8 8m0-8l-8 8"
    return tag("path", d=cross, stroke=BAD, stroke_width=2, fill="none", class_="bad")


def _band(area: Area, low: float, high: float) -> str:
    top, bottom = area.y(high), area.y(low)
    x, width = LEFT, WIDTH - LEFT - RIGHT
    fill = tag("rect", x=x, y=top, width=width, height=bottom - top, fill=BAND, fill_opacity=0.16)
    return fill + _edges(x, x + width, (top, bottom))


def _edges(left: float, right: float, heights: Iterable[float]) -> str:
    lines: Sequence[str] = [f"M{coordinate(left)} {coordinate(y)}H{coordinate(right)}" for y in heights]
    return tag("path", d="".join(lines), stroke=BAND, stroke_width=1)


def _dashes(area: Area, value: float) -> str:
    path = f"M{coordinate(LEFT)} {coordinate(area.y(value))}H{coordinate(WIDTH - RIGHT)}"
    return tag("path", d=path, stroke=BAND, stroke_width=1.5, stroke_dasharray="6 4", class_="wanted")

"""Checks of what a node logs of the turtle: where it is, how far it has come; against the simulator's own frames."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.kind import Kind, number, text
from grader.checks.outcome import Finding, Status, failed, passed
from grader.common.lazy import np
from grader.evidence import lines

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.evidence.evidence import Evidence
    from grader.evidence.lines import Line
    from grader.trial.recording import Floats, Recording

EARLY_S = 0.02
"""A frame and a little: the simulator's frame and the line bear times of their own."""
FEWEST = 3


@dataclass(frozen=True, kw_only=True)
class LogPosition:
    """A line's x and y may be that old (`lag_s`), and off by the tolerance."""

    format: str = text(
        "a line of the log, with x and y in it", about="The format of a line; its numbers `x` and `y` count."
    )
    tolerance_m: float = number(0.02, above=0, about="How far x and y may be off.")
    lag_s: float = number(0.15, above=0, about="How old the position in a line may be.")


@dataclass(frozen=True, kw_only=True)
class LogDistance:
    """A line's distance, the way driven since the start, may be that old (`lag_s`), and off by the tolerance."""

    format: str = text(
        "a line of the log, with distance in it", about="The format of a line; its number `distance` counts."
    )
    tolerance_m: float = number(0.05, above=0, about="How far the distance may be off.")
    lag_s: float = number(0.15, above=0, about="How old the distance in a line may be.")


def log_position(evidence: Evidence, params: LogPosition) -> Finding:
    """Every line says where the turtle was when it was logged."""
    recording, frames = evidence.recording, evidence.recording.frames
    said = _trusted(recording, params.format)
    expected = "Each line says where the turtle is at that moment, to two digits behind the point."
    if len(said) < FEWEST:
        return _too_few(evidence, params.format)

    def off(line: Line, x: float, y: float) -> float:
        near = _window(recording, line.t_s, params.lag_s)
        return float(np.hypot(frames.x[near] - x, frames.y[near] - y).min())

    wrong = [line for line in said if not off(line, line.numbers["x"], line.numbers["y"]) <= params.tolerance_m]
    if not wrong:
        return passed("Each line says where the turtle is.")
    line = wrong[0]
    x, y = _at(recording, line.t_s, frames.x), _at(recording, line.t_s, frames.y)
    seen = (
        f"At {line.t_s:.0f} s the line says x={line.numbers['x']:.2f} y={line.numbers['y']:.2f}, "
        f"and the turtle was at x={x:.2f} y={y:.2f}."
    )
    diagnosis, cause = "wrong-position", "x and y are fields of the message that the subscription hands to your method."
    if all(off(each, each.numbers["y"], each.numbers["x"]) <= params.tolerance_m for each in said):
        diagnosis, cause = "x-y-swapped", "x and y have changed places."
    elif len({(each.numbers["x"], each.numbers["y"]) for each in said}) == 1:
        diagnosis, cause = "stale-pose", "The numbers never change: keep what each new message says, in self."
    return failed(diagnosis, seen, expected, cause, where=evidence.place("info", "create_subscription"))


def log_distance(evidence: Evidence, params: LogDistance) -> Finding:
    """Every line says how far the turtle has driven since the start."""
    recording, frames = evidence.recording, evidence.recording.frames
    said = _trusted(recording, params.format)
    expected = "The distance is the length of the way driven so far, in metres; it never gets less."
    if len(said) < FEWEST:
        return _too_few(evidence, params.format)
    x, y = np.append(recording.start.x, frames.x), np.append(recording.start.y, frames.y)
    way = np.cumsum(np.hypot(np.diff(x), np.diff(y)))

    def holds(values: Floats, number_of: Callable[[Line], float]) -> bool:
        return all(
            float(np.abs(values[_window(recording, line.t_s, params.lag_s)] - number_of(line)).min())
            <= params.tolerance_m
            for line in said
        )

    if holds(way, lambda line: line.numbers["distance"]):
        return passed("Each line says how far the turtle has driven.")
    worst = max(said, key=lambda line: abs(line.numbers["distance"] - _at(recording, line.t_s, way)))
    seen = (
        f"At {worst.t_s:.0f} s the line says distance={worst.numbers['distance']:.2f}, "
        f"and the turtle had driven {_at(recording, worst.t_s, way):.2f} m."
    )
    where = evidence.place("hypot", "sqrt", "dist", "info")
    numbers = [line.numbers["distance"] for line in said]
    if not any(numbers):
        return failed("distance-zero", seen, expected, "The distance stays 0: add to it with every pose.", where=where)
    if holds(
        np.hypot(frames.x - recording.start.x, frames.y - recording.start.y), lambda line: line.numbers["distance"]
    ):
        cause = "This is the straight line back to the start. The way is the sum of all the small steps between poses."
        return failed("distance-from-start", seen, expected, cause, where=where)
    if holds(np.hypot(frames.x, frames.y), lambda line: line.numbers["distance"]) or _one_step_too_many(
        said, way, recording
    ):
        cause = "The first pose has none before it: there is nothing to add yet. Not even the way from x=0 y=0."
        return failed("distance-from-zero", seen, expected, cause, where=where)
    if _is_chords(said, numbers):
        cause = (
            "It adds one straight line a second, between the places that are logged; a turtle that turns in between "
            "goes further. Add a step with every pose that arrives."
        )
        return failed("distance-by-chords", seen, expected, cause, where=where)
    cause = "Between two poses the turtle moves by the root of dx squared plus dy squared; their sum is the distance."
    return failed("wrong-distance", seen, expected, cause, where=where)


def _trusted(recording: Recording, text_: str) -> list[Line]:
    """The lines in the format that no stall of the machine delayed."""
    return [line for line in lines.in_format(recording, text_) if not recording.stalled(line.t_s)]


def _too_few(evidence: Evidence, text_: str) -> Finding:
    if len(lines.in_format(evidence.recording, text_)) >= FEWEST:
        return Finding(Status.ERROR, "The machine was too busy in wall time. Try again when it is not.")
    expected = f"At least {FEWEST} lines in the format."
    where = evidence.place("info")
    return failed("too-few-log-lines", "There are too few lines to compare.", expected, where=where)


def _window(recording: Recording, t_s: float, lag_s: float) -> slice:
    """The frames that a line of this time may speak of; at least one."""
    times = recording.frames.t_s
    begin = int(np.searchsorted(times, t_s - lag_s))
    end = int(np.searchsorted(times, t_s + EARLY_S))
    begin = min(begin, len(times) - 1)
    return slice(begin, max(end, begin + 1))


def _at(recording: Recording, t_s: float, values: Floats) -> float:
    """The value of the last frame before this time."""
    return float(values[max(int(np.searchsorted(recording.frames.t_s, t_s)) - 1, 0)])


def _is_chords(said: list[Line], numbers: list[float]) -> bool:
    steps = np.hypot(np.diff([line.numbers["x"] for line in said]), np.diff([line.numbers["y"] for line in said]))
    return bool(np.allclose(np.diff(numbers), steps, atol=0.03)) and any(numbers)


def _one_step_too_many(said: list[Line], way: Floats, recording: Recording) -> bool:
    first = math.hypot(recording.start.x, recording.start.y)
    return all(abs(line.numbers["distance"] - _at(recording, line.t_s, way) - first) < 0.5 for line in said)


LOG_POSITION = Kind(
    "log_position",
    "trial",
    "The log says where the turtle is",
    LogPosition,
    log_position,
    about="Every line in the format says where the turtle was when it was logged.",
)
LOG_DISTANCE = Kind(
    "log_distance",
    "trial",
    "The log says how far it has come",
    LogDistance,
    log_distance,
    about="Every line in the format says how far the turtle had driven when it was logged.",
)

"""Checks of the logged position and distance of the turtle, compared with the simulator's frames."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.log_place import log_place
from grader.checks.causes.why_steering import rounded_steps
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.starved import too_busy
from grader.checks.subjects.log import unless_other_numbers
from grader.common.lazy import np
from grader.common.words import shorten
from grader.evidence import student_log
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.evidence.evidence import Evidence
    from grader.evidence.student_log import Line
    from grader.trial.recording import Floats, Recording

EARLY_S = 0.02
"""The frame that a log line describes may be up to this much (s) later: the times of log lines are not exact.

This time is slightly longer than one frame.
"""
FEWEST = 3
LENGTHS = ("hypot", "sqrt", "dist")
"""Functions that can compute the distance between two positions."""


@dataclass(frozen=True, kw_only=True)
class LogPosition:
    """The logged x and y may be up to `lag_s` old and may differ from the turtle's position by up to the tolerance."""

    format: str = string(
        "a log line that contains {x} and {y}", about="The format of a line with the numbers `x` and `y`."
    )
    tolerance_m: float = number(0.02, above=0, about="The maximum error of x and y.")
    lag_s: float = number(0.15, above=0, about="The maximum age of the position in a line.")


@dataclass(frozen=True, kw_only=True)
class LogDistance:
    """The logged distance is the distance driven since the start.

    It may be up to `lag_s` old and may differ from the real distance by up to the tolerance.
    """

    format: str = string(
        "a log line that contains {distance}", about="The format of a line with the number `distance`."
    )
    tolerance_m: float = number(0.05, above=0, about="The maximum error in the distance.")
    lag_s: float = number(0.15, above=0, about="The maximum age of the distance in a line.")


def log_position(evidence: Evidence, params: LogPosition) -> Finding:
    """Every line shows the position of the turtle at the time of logging."""
    recording, frames = evidence.recording, evidence.recording.frames
    logged = _trusted(recording, params.format)
    expected = "Each line shows where the turtle is at that moment, with two decimal places."
    if len(logged) < FEWEST:
        return _too_few(evidence, params.format)

    where = log_place(evidence, student_log.Format(params.format).example())
    early = [line for line in logged if line.t_s < evidence.trial.scenario.pose_from_s]
    if early:
        observed = "A line with numbers was logged before the first pose arrived."
        cause = (
            "Before the first pose, the position is unknown, not 0. Until the first pose arrives, store None and log "
            "nothing."
        )
        return failed(observed, expected, Cause("before-first-pose", cause, where))

    def off(line: Line, x: float, y: float) -> float:
        near = _window(recording, line.t_s, params.lag_s)
        return float(np.hypot(frames.x[near] - x, frames.y[near] - y).min())

    wrong = [line for line in logged if not off(line, line.numbers["x"], line.numbers["y"]) <= params.tolerance_m]
    if not wrong:
        return passed("Each line shows where the turtle is.")
    line = wrong[0]
    x, y = _at(recording, line.t_s, frames.x), _at(recording, line.t_s, frames.y)
    observed = (
        f"At {line.t_s:.0f} s, the line shows x={line.numbers['x']:.2f} y={line.numbers['y']:.2f}, "
        f"but the turtle was at x={x:.2f} y={y:.2f}."
    )
    why = Cause("wrong-position", "x and y are fields of the message that your callback receives.")
    if all(off(each, each.numbers["y"], each.numbers["x"]) <= params.tolerance_m for each in logged):
        why = Cause("x-y-swapped", "x and y are swapped.")
    elif len({(each.numbers["x"], each.numbers["y"]) for each in logged}) == 1:
        why = Cause("stale-pose", "The numbers never change. Store x and y in self each time a message arrives.")
    return failed(observed, expected, why.at(where))


def log_distance(evidence: Evidence, params: LogDistance) -> Finding:
    """Every line shows the distance that the turtle has driven since the start."""
    recording, frames = evidence.recording, evidence.recording.frames
    from_s = evidence.trial.scenario.pose_from_s
    logged = [line for line in _trusted(recording, params.format) if line.t_s >= from_s]
    expected = "The distance is the length of the path that the turtle has driven, in metres. It never gets smaller."
    if len(logged) < FEWEST:
        return _too_few(evidence, params.format, from_s)
    x, y = np.append(recording.start.x, frames.x), np.append(recording.start.y, frames.y)
    driven = np.cumsum(np.hypot(np.diff(x), np.diff(y)))

    def holds(values: Floats, number_of: Callable[[Line], float]) -> bool:
        return all(
            float(np.abs(values[_window(recording, line.t_s, params.lag_s)] - number_of(line)).min())
            <= params.tolerance_m
            for line in logged
        )

    if holds(driven, lambda line: line.numbers["distance"]):
        return passed("Each line shows how far the turtle has driven.")
    worst = max(logged, key=lambda line: abs(line.numbers["distance"] - _at(recording, line.t_s, driven)))
    observed = (
        f"At {worst.t_s:.0f} s, the line shows distance={worst.numbers['distance']:.2f}, "
        f"but the turtle had driven {_at(recording, worst.t_s, driven):.2f} m."
    )
    computed = any(evidence.code.calls(name) for name in LENGTHS)
    where = (None if computed else _added(evidence)) or evidence.place(*LENGTHS, "info")
    numbers = [line.numbers["distance"] for line in logged]
    if not any(numbers):
        why = _overwritten(evidence) or Cause(
            "distance-zero",
            "The distance stays 0. Each time a pose arrives, the step from the previous pose must be added.",
        )
        return failed(observed, expected, why.at(where))
    if holds(
        np.hypot(frames.x - recording.start.x, frames.y - recording.start.y), lambda line: line.numbers["distance"]
    ):
        cause = (
            "This is the length of the straight line to the start. The distance is the sum of all small steps, from "
            "each pose to the next."
        )
        return failed(observed, expected, Cause("distance-from-start", cause, where))
    if holds(np.hypot(frames.x, frames.y), lambda line: line.numbers["distance"]) or _one_step_too_many(
        logged, driven, recording
    ):
        cause = (
            "There is no pose before the first one, so there is nothing to add yet, not even the distance from x=0 y=0."
        )
        return failed(observed, expected, Cause("distance-from-zero", cause, where))
    again = _assigned_again(evidence) if min(np.diff(numbers)) < 0.0 else None
    if again is not None:
        cause = f"Line {again.line} replaces the distance instead of adding to it."
        return failed(observed, expected, Cause("distance-replaced", cause, again))
    if _is_chords(logged, numbers):
        cause = (
            "The node adds straight lines from each logged position to the next. On a curve, the path is longer. "
            "Add a step each time a pose arrives."
        )
        return failed(observed, expected, Cause("distance-by-chords", cause, where))
    cause = (
        "Between two poses the turtle moves by the square root of dx * dx + dy * dy. "
        "The distance is the sum of these steps."
    )
    if holds(np.cumsum(np.abs(np.diff(x)) + np.abs(np.diff(y))), lambda line: line.numbers["distance"]):
        cause = "This is the sum of abs(dx) + abs(dy). A step is the square root of dx * dx + dy * dy."
        return failed(observed, expected, Cause("wrong-distance", cause, where))
    return failed(observed, expected, rounded_steps(evidence) or Cause("wrong-distance", cause, where))


def _assigned_again(evidence: Evidence) -> Where | None:
    """Return the first line outside __init__ that overwrites the attribute that is logged as distance, or None.

    A line that uses the old value, such as a sum, does not count.
    """
    shown = " ".join(ast.unparse(each.node) for each in evidence.code.calls("info"))
    for module in evidence.code.modules:
        for method in (node for node in module.nodes if isinstance(node, ast.FunctionDef) and node.name != "__init__"):
            for node in (node for node in ast.walk(method) if isinstance(node, ast.Assign)):
                name = dotted(node.targets[0]) or ""
                if name.startswith("self.") and f"distance={{{name}:" in shown and name not in ast.unparse(node.value):
                    return Where(module.file, node.lineno)
    return None


def _added(evidence: Evidence) -> Where | None:
    """Return the first line that increases a logged attribute with +=, or None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
                name = dotted(node.target) or ""
                if name.startswith("self.") and any(
                    name in ast.unparse(each.node) for each in evidence.code.calls("info")
                ):
                    return Where(module.file, node.lineno)
    return None


def _overwritten(evidence: Evidence) -> Cause | None:
    """Return the cause if a method replaces the last pose before calculating the distance from that pose, else None."""
    for module in evidence.code.modules:
        for method in (node for node in module.nodes if isinstance(node, ast.FunctionDef)):
            given = {argument.arg for argument in method.args.args} - {"self"}
            inside = list(ast.walk(method))
            for kept in method.body:
                if not (isinstance(kept, ast.Assign) and (dotted(kept.value) or "").partition(".")[0] in given):
                    continue
                name = dotted(kept.targets[0]) or ""
                steps = [node for node in inside if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub)]
                whole = isinstance(kept.value, ast.Name)
                reads = [node.lineno for node in steps if _reads(node, f"{name}." if whole else name)]
                if name.startswith("self.") and reads and kept.lineno < min(reads):
                    text = (
                        f"Line {kept.lineno} replaces {shorten(name)} before the step from the old value is calculated."
                    )
                    return Cause("distance-zero", text, Where(module.file, kept.lineno))
    return None


def _reads(step: ast.BinOp, begin: str) -> bool:
    """Return whether the subtraction uses the attribute `begin`, such as "self.x".

    If `begin` ends with a dot, as in "self.pose.", each attribute of that object counts.
    """
    names = [dotted(node) or "" for node in ast.walk(step) if isinstance(node, ast.Attribute)]
    return any(name.startswith(begin) if begin.endswith(".") else name == begin for name in names)


def _trusted(recording: Recording, format_: str) -> list[Line]:
    """Return the lines in the required format, except lines that a stall of the machine may have delayed."""
    return [line for line in student_log.in_format(recording, format_) if not recording.stalled(line.t_s)]


def _too_few(evidence: Evidence, text_: str, from_s: float = 0.0) -> Finding:
    if sum(line.t_s >= from_s for line in student_log.in_format(evidence.recording, text_)) >= FEWEST:
        return too_busy()
    example = student_log.Format(text_).example()
    expected = f'The log has at least {FEWEST} lines such as "{example}".'
    where = log_place(evidence, example)
    finding = failed("There are too few lines to compare.", expected, Cause("too-few-log-lines", where=where))
    return unless_other_numbers(finding, evidence, text_)


def _window(recording: Recording, t_s: float, lag_s: float) -> slice:
    """Return the frames (at least one) that a line logged at this time can describe."""
    times = recording.frames.t_s
    begin = int(np.searchsorted(times, t_s - lag_s))
    end = int(np.searchsorted(times, t_s + EARLY_S))
    begin = min(begin, len(times) - 1)
    return slice(begin, max(end, begin + 1))


def _at(recording: Recording, t_s: float, values: Floats) -> float:
    """Return the value at the last frame before this time, or at the first frame if none is earlier."""
    return float(values[max(int(np.searchsorted(recording.frames.t_s, t_s)) - 1, 0)])


def _is_chords(logged: list[Line], numbers: list[float]) -> bool:
    """Return whether the lines show positions, and the logged distance is the sum of the steps between them."""
    if not logged[0].numbers.keys() >= {"x", "y"}:
        return False
    steps = np.hypot(np.diff([line.numbers["x"] for line in logged]), np.diff([line.numbers["y"] for line in logged]))
    return bool(np.allclose(np.diff(numbers), steps, atol=0.03)) and any(numbers)


def _one_step_too_many(logged: list[Line], driven: Floats, recording: Recording) -> bool:
    first = math.hypot(recording.start.x, recording.start.y)
    return all(abs(line.numbers["distance"] - _at(recording, line.t_s, driven) - first) < 0.5 for line in logged)


LOG_POSITION = Kind(
    "log_position",
    "trial",
    "The log shows where the turtle is",
    LogPosition,
    log_position,
    about="Each log line that matches `format` shows where the turtle was when the line was logged.",
)
LOG_DISTANCE = Kind(
    "log_distance",
    "trial",
    "The log shows how far the turtle has driven",
    LogDistance,
    log_distance,
    about="Each log line that matches `format` shows how far the turtle had driven when the line was logged.",
)

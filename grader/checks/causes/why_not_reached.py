"""Explain why a turtle that drives until the end does not reach or catch a target."""

from __future__ import annotations

import ast
import math
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_silent import never_called
from grader.checks.own_values import drawn_numbers
from grader.common.lazy import np
from grader.common.words import shorten
from grader.evidence.targets import is_there, place_at
from grader.exercise.own_numbers import OwnNumbers
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call

CATCH = "/catch"
LEVELS = ("debug", "info", "warning", "warn", "error", "fatal")
"""The methods of a logger that write a log message."""
TURNS_RAD_S = 0.1
"""A turtle with a smaller angular velocity (rad/s) is considered not to turn."""
ASIDE_RAD = 0.3
"""A target within this angle (rad) is considered straight ahead or straight behind, so a turn in either direction is
right."""
MOST = 0.8
"""The node is considered to turn in the wrong direction if at least this fraction of its commands to turn do one of two
things: they turn turtle1 away from the target, or they arrive while turtle1 faces away from it."""
FEWEST, FEWEST_AWAY = 10, 3
"""The minimum number of turns, and of turns away from the target, that are needed for a conclusion."""


def why_not_reached(evidence: Evidence, name: str, near_m: float) -> Cause | None:
    """Return the reason why turtle1 came within `near_m` (m) of this target without catching it, or None."""
    reach_m = _own_reach_m(evidence)
    asked = any(call.service == CATCH and call.request["name"] == name for call in evidence.recording.calls)
    if reach_m is not None and near_m < reach_m and not asked:
        unasked = _no_client(evidence) or never_called(evidence, ("call_async", "call"))
        if unasked is not None:
            return unasked
        text = (
            f"The turtle came within {near_m:.2f} m of {shorten(name)}, and your reach is {reach_m:g} m, but the "
            f"node did not call {CATCH} for this target. Which distance does the node compare with your reach?"
        )
        return Cause("reach-too-small", text, _constant(evidence, "REACH") or evidence.place("call_async"))
    return _farthest(evidence) or wrong_turn(evidence)


def _no_client(evidence: Evidence) -> Cause | None:
    """Return the cause if the node creates no client at all, else None."""
    if evidence.code.calls("create_client"):
        return None
    text = f"The node has no client, so it calls no service. {CATCH} is a service, not a topic."
    return Cause("service-not-called", text, evidence.code.start)


def _own_reach_m(evidence: Evidence) -> float | None:
    drawn = drawn_numbers(evidence) if evidence.exercise.numbers is not None else None
    value = drawn.values.get("reach_m") if isinstance(drawn, OwnNumbers) else None
    return None if value is None else float(value)


def _constant(evidence: Evidence, name: str) -> Where | None:
    """Return the line that assigns a constant with this name, or None."""
    for module in evidence.code.modules:
        for node in module.body:
            if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == name for t in node.targets):
                return Where(module.file, node.lineno)
    return None


def _wrong_angle(evidence: Evidence) -> Cause | None:
    """Return the cause if the arguments of atan2 are swapped, or an angle is converted to degrees, else None."""
    for call in evidence.code.calls("atan2"):
        axes = [_axes(argument) for argument in call.node.args]
        if axes == [{"x"}, {"y"}]:
            text = "math.atan2 takes the difference in y first, and then the difference in x."
            return Cause("atan2-swapped", text, call.where)
    converted = evidence.code.calls("degrees") + evidence.code.calls("rad2deg")
    degrees = next((call for call in converted if not _is_logged(evidence, call)), None)
    if degrees is None:
        return None
    text = "The heading theta and angular.z are in radians, but this line converts an angle to degrees."
    return Cause("angle-in-degrees", text, degrees.where)


def _is_logged(evidence: Evidence, converted: Call) -> bool:
    """Return whether only log messages use the angle in degrees, directly or through a variable."""
    logs = _logs(evidence)
    if any(_contains(log, converted) for log in logs):
        return True
    names = [
        node.targets for node in converted.module.nodes if isinstance(node, ast.Assign) and node.value is converted.node
    ]
    name = dotted(names[0][0]) if names else None
    read = [
        node
        for node in converted.module.nodes
        if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load) and dotted(node) == name
    ]
    logged = {id(each) for log in logs for each in ast.walk(log.node)}
    return name is not None and bool(read) and all(id(node) in logged for node in read)


def _logs(evidence: Evidence) -> list[Call]:
    return [call for name in (*LEVELS, "print") for call in evidence.code.calls(name)]


def _contains(outer: Call, inner: Call) -> bool:
    return any(node is inner.node for node in ast.walk(outer.node))


def _axes(node: ast.expr) -> set[str]:
    """Return the coordinates, "x" and "y", to which the names in an expression such as `place.x - x0` or `dx` refer."""
    names = [each.id for each in ast.walk(node) if isinstance(each, ast.Name)]
    names += [each.attr for each in ast.walk(node) if isinstance(each, ast.Attribute)]
    return {axis for axis in ("x", "y") if {axis, f"d{axis}", f"delta_{axis}", f"{axis}_diff"} & set(names)}


def _farthest(evidence: Evidence) -> Cause | None:
    """Return the cause if the node calls max with a key that has no minus sign, and never calls min, else None."""
    keys = [(call, call.argument(99, "key")) for call in evidence.code.calls("max")]
    chosen = [call for call, key in keys if key is not None and not _negates(key, call)]
    if not chosen or evidence.code.calls("min"):
        return None
    text = "max with a key returns the target for which the key, such as the distance, is largest."
    return Cause("farthest-chosen", text, chosen[0].where)


def _negates(key: ast.expr, call: Call) -> bool:
    """Return whether the key has a minus sign or a division, so that max returns the nearest target.

    They may also be in a function of the module that the key names or calls.
    """
    names = {getattr(node, "attr", getattr(node, "id", "")) for node in ast.walk(key)}
    functions = [node for node in call.module.nodes if isinstance(node, ast.FunctionDef) and node.name in names]
    return any(isinstance(node, ast.USub | ast.Div) for part in (key, *functions) for node in ast.walk(part))


def wrong_turn(evidence: Evidence) -> Cause | None:
    """Return the cause if the source computes a wrong angle or turtle1 turned away from the target, else None."""
    return _wrong_angle(evidence) or _turns_away(evidence)


def _turns_away(evidence: Evidence) -> Cause | None:
    """Return the cause if turtle1 usually turned away from the nearest target or faced away from it, else None."""
    turns = list(_turns(evidence))
    away, faced = turns.count("away"), turns.count("behind")
    if away < FEWEST_AWAY or len(turns) < FEWEST or away + faced < MOST * len(turns):
        return None
    text = (
        f"In {away + faced} of {len(turns)} commands to turn, the turtle turned away from the nearest target, or faced "
        "away from it. A positive angular.z turns to the left: the error is the direction to the target minus theta."
    )
    return Cause("turns-away", text, evidence.code.assigned("angular", "z") or evidence.place("publish"))


def _turns(evidence: Evidence) -> Iterator[str]:
    """Yield, for each command that turned turtle1, the side on which the nearest target was.

    The target was ahead, behind, on the side to which the turtle turned ("towards"), or on the other side ("away").
    """
    recording = evidence.recording
    frames = recording.frames
    for command in evidence.commands:
        turn = command.angular[2]
        there = [track for track in recording.tracks if is_there(track, command.t_s, command.t_s)]
        index = min(int(np.searchsorted(frames.t_s, command.t_s)), len(frames.t_s) - 1)
        if abs(turn) < TURNS_RAD_S or not there or index < 0:
            continue
        x, y = float(frames.x[index]), float(frames.y[index])
        places = [place_at(track, command.t_s) for track in there]
        to_x, to_y = min(places, key=lambda place: math.hypot(place[0] - x, place[1] - y))
        error = math.remainder(math.atan2(to_y - y, to_x - x) - float(frames.theta[index]), math.tau)
        if abs(error) <= ASIDE_RAD:
            yield "ahead"
        elif abs(error) >= math.pi - ASIDE_RAD:
            yield "behind"
        else:
            yield "away" if turn * error < 0 else "towards"

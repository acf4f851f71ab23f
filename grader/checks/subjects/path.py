"""Checks of the turtle's way: the circle that was asked for, clear of the walls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.causes.crash import ended_early
from grader.checks.kind import Kind, NoParams, choice, number
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.tolerance import Band
from grader.common.words import count, shorten
from grader.common.words import number as shown
from grader.evidence import observed as seen_in

if TYPE_CHECKING:
    from grader.evidence.circle_fit import Circle
    from grader.evidence.evidence import Evidence
    from grader.evidence.track import Track
    from grader.submission.where import Where
    from grader.trial.recording import Pose

MOVED_M = 0.05
"""A turtle that got no further than this did not move."""
TURNED_RAD = 0.1
STRAIGHT_RADIUS_M = 50.0
"""A circle larger than this looks straight on a canvas of 11 m."""
LIVES_S = 1.0
"""How long a command moves a turtle."""
MEANS = frozenset({"reset", "kill", "teleport_absolute", "teleport_relative", "rotate_absolute", "set_parameters"})
"""Calls that move a turtle, take it away or change how it moves; the pen and other turtles are anybody's."""
POLYGON_SHARE = 0.6
"""A way of which more than this was driven straight is told as sides and corners."""


@dataclass(frozen=True, kw_only=True)
class CircleParams:
    """The circle; its centre lies `radius_m` to the left of the turtle's start (clockwise: to the right).

    `residual_m`: root of the mean squared distance of the way from the fitted circle. `turns`: at least so many.
    """

    radius_m: float = number(
        above=0,
        at_most=5.5,
        about="The radius. The centre lies this far to the left of the start (clockwise: to the right).",
    )
    radius_tolerance_m: float = number(0.05, above=0, about="How far the radius may be off.")
    centre_tolerance_m: float = number(0.05, above=0, about="How far the centre may be off.")
    residual_m: float = number(
        0.02, above=0, about="How far the trajectory may stray from the fitted circle (root mean square)."
    )
    turns: float = number(1.0, above=0, about="How many turns the turtle must drive at least.")
    sense: str = choice("counter-clockwise", "clockwise", about="The direction of the turn.")


def expected_centre(start: Pose, params: CircleParams) -> tuple[float, float]:
    """The centre (m) of the circle that was asked for, seen from the turtle's start."""
    side = 1.0 if params.sense == "counter-clockwise" else -1.0
    return (
        start.x - side * params.radius_m * math.sin(start.theta),
        start.y + side * params.radius_m * math.cos(start.theta),
    )


def circle(evidence: Evidence, params: CircleParams) -> Finding:
    """The turtle drives the circle: round, in the right sense, of the right size, in the right place, all the way."""
    turns = "1 turn" if params.turns == 1.0 else f"{params.turns:g} turns"
    expected = f"A circle of radius {params.radius_m:.1f} m, {params.sense}, at least {turns}."
    moved = moved_otherwise(evidence, expected)
    if moved is not None:
        return moved
    track = evidence.track
    return _no_circle(evidence, track, expected) or _measured(evidence, params, track, expected)


def moved_otherwise(evidence: Evidence, expected: str) -> Finding | None:
    """A failed finding where something other than commands moved the turtle."""
    means = next((each for each in evidence.recording.interventions if each in MEANS), None)
    if means is None:
        return None
    seen = f"Something moved the turtle by other means: {shorten(means)}."
    cause = "The turtle is to be driven by velocity commands alone."
    return failed("intervention", seen, expected, cause, where=evidence.place("create_client", "ActionClient"))


def not_driven(evidence: Evidence, expected: str, where: Where | None) -> Finding | None:
    """A failed finding where commands did not move the turtle: nothing did, or something else."""
    moved = moved_otherwise(evidence, expected)
    if moved is not None or (evidence.track.finite and evidence.track.length_m > MOVED_M):
        return moved
    return failed("not-moving", "The turtle did not drive.", expected, where=where)


def _no_circle(evidence: Evidence, track: Track, expected: str) -> Finding | None:
    """What makes a way no circle at all, the most telling reason first."""
    if not track.finite:
        seen = "The turtle's position became NaN (not a number)."
        return failed("not-a-number", seen, expected, "A command was no finite number.", where=_line(evidence))
    if track.length_m <= MOVED_M:
        if track.turned_rad > TURNED_RAD:
            cause = "linear.x is the speed forwards; without it there is nothing but turning."
            return failed("turns-on-the-spot", "The turtle turned on the spot.", expected, cause, where=_line(evidence))
        return failed("not-moving", "The turtle did not move.", expected, _all_zero(evidence), where=_line(evidence))
    if track.wall.any():
        seen = f"The turtle ran into a wall after {_wall_s(track):.1f} s."
        return failed("wall", seen, expected, _size(evidence), where=_line(evidence))
    fitted = track.circle
    if fitted is None or fitted.radius > STRAIGHT_RADIUS_M:
        cause = "A turtle that never turns drives straight on: angular.z is the turning speed."
        return failed("straight-line", "The turtle drove straight on.", expected, cause, where=_line(evidence))
    return None


def _measured(evidence: Evidence, params: CircleParams, track: Track, expected: str) -> Finding:
    fitted = track.circle
    assert fitted is not None
    turns = track.turns
    centre = math.dist((fitted.x, fitted.y), expected_centre(evidence.recording.start, params))
    round_, size = Band.at_most(params.residual_m), Band.around(params.radius_m, params.radius_tolerance_m)
    place, long = Band.at_most(params.centre_tolerance_m), Band.at_least(params.turns)
    if not round_.holds(fitted.rms):
        return _not_round(evidence, track, fitted, expected, near_edge=round_.near(fitted.rms))
    forward = turns if params.sense == "counter-clockwise" else -turns
    if not forward > 0.0:
        sense = "clockwise" if turns < 0.0 else "counter-clockwise"
        cause = "The sign of angular.z decides: above 0 turns to the left, counter-clockwise."
        return failed("wrong-sense", f"The turtle drove its circle {sense}.", expected, cause, where=_line(evidence))
    near = round_.near(fitted.rms) or size.near(fitted.radius) or place.near(centre) or long.near(forward)
    if not size.holds(fitted.radius):
        seen = f"The circle's radius is {shown(round(fitted.radius, 2))} m."
        return failed("wrong-radius", seen, expected, _size(evidence), where=_line(evidence), near_edge=near)
    if not place.holds(centre):
        seen = f"The circle is right in size, but lies {centre:.2f} m beside its place."
        cause = "The turtle left its start before the circle began: the first commands differ from the rest."
        return failed("wrong-centre", seen, expected, cause, where=_line(evidence), near_edge=near)
    if not long.holds(forward):
        return _too_short(evidence, track, forward, expected, near_edge=near)
    return passed(expected.replace("A circle", "The turtle drove a circle"), near_edge=near)


def _not_round(evidence: Evidence, track: Track, fitted: Circle, expected: str, *, near_edge: bool) -> Finding:
    off = f"it strays {max(fitted.rms, 0.01):.2f} m (RMS) from the nearest circle"
    if track.straight_share > POLYGON_SHARE:
        if track.sides == 1:
            return failed("straight-line", "The turtle drove straight on.", expected, "", where=_line(evidence))
        seen = f"The way is {track.sides} straight sides with corners; {off}."
        cause = "A circle is driven by going forwards and turning at the same time, in every command."
        return failed("polygon", seen, expected, cause, where=_line(evidence), near_edge=near_edge)
    changed = len({(command.linear, command.angular) for command in evidence.commands}) > 1
    cause = (
        "The commands change on the way; a circle needs the same command all the time."
        if changed
        else ended_early(evidence)
    )
    return failed(
        "not-round", f"The way is not round: {off}.", expected, cause, where=_line(evidence), near_edge=near_edge
    )


def _too_short(evidence: Evidence, track: Track, turns: float, expected: str, *, near_edge: bool) -> Finding:
    seen = f"The turtle drove {turns:.2f} of a turn."
    early = ended_early(evidence)
    if early:
        return failed("ended-early", seen, expected, early, where=evidence.place("publish"), near_edge=near_edge)
    if track.rests:
        seen = f"The turtle drove {turns:.2f} of a turn, with {count(track.rests, 'stop')} on the way."
        diagnosis, cause = "stops-and-goes", "A turtle stops when no command comes for 1 s."
    elif seen_in.end_s(evidence.recording) - evidence.commands[-1].t_s > LIVES_S:
        seen = f"The turtle drove {turns:.2f} of a turn; the last command came at {evidence.commands[-1].t_s:.1f} s."
        diagnosis, cause = "stopped-early", "A turtle stops when no command comes for 1 s."
    else:
        speed = _steady(evidence)
        turn_s = 2.0 * math.pi / abs(speed[1]) if speed and speed[1] else 0.0
        cause = f"At angular.z {shown(speed[1])} rad/s a turn takes {turn_s:.1f} s." if speed and turn_s else ""
        return failed("too-short", seen, expected, cause, where=_line(evidence), near_edge=near_edge)
    return failed(diagnosis, seen, expected, cause, where=evidence.place("publish"), near_edge=near_edge)


def _steady(evidence: Evidence) -> tuple[float, float] | None:
    """linear.x (m/s) and angular.z (rad/s) of the commands when they are all the same."""
    found = {(command.linear[0], command.angular[2]) for command in evidence.commands}
    return next(iter(found)) if len(found) == 1 else None


def _size(evidence: Evidence) -> str:
    """What size of circle the commands ask for, in words."""
    speed = _steady(evidence)
    if speed is None or not all(map(math.isfinite, speed)):
        return ""
    if not speed[1]:
        return "angular.z is 0, so the turtle drives straight on."
    radius = abs(speed[0] / speed[1])
    return f"The radius is linear.x divided by angular.z: {shown(speed[0])} / {shown(speed[1])} = {shown(radius)} m."


def _all_zero(evidence: Evidence) -> str:
    commands = evidence.commands
    zero = commands and not any(command.linear[0] or command.angular[2] for command in commands)
    return "In every command linear.x and angular.z are 0." if zero else ""


def _line(evidence: Evidence) -> Where | None:
    code = evidence.code
    return code.assigned("angular", "z") or code.assigned("linear", "x") or evidence.place("Twist", "publish")


def _wall_s(track: Track) -> float:
    """When the turtle first was at a wall (s)."""
    return float(track.t_s[int(track.wall.argmax())])


def no_wall(evidence: Evidence, _: NoParams) -> Finding:
    """No frame was clamped to the canvas; nothing is said of a turtle that never moved."""
    track = evidence.track
    # Whoever is put back in time never meets a wall.
    moved = moved_otherwise(evidence, "It stays clear of the walls all the time.")
    if moved is not None:
        return moved
    if track.wall.any():
        seen = f"The turtle ran into a wall after {_wall_s(track):.1f} s."
        expected = "It stays clear of the walls all the time."
        return failed("wall", seen, expected, _size(evidence), where=_line(evidence))
    if not (track.finite and track.length_m > MOVED_M):
        return Finding(Status.SKIPPED, "Not judged, since the turtle did not drive.")
    return passed("The turtle stayed clear of the walls.")


CIRCLE = Kind(
    "circle",
    "trial",
    "The turtle drives the circle",
    CircleParams,
    circle,
    about="The turtle drives a circle by commands: round, in the right direction, of the right size and place.",
)
NO_WALL = Kind(
    "no_wall", "trial", "The turtle touches no wall", NoParams, no_wall, about="The turtle never touches a wall."
)

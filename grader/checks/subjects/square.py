"""Check of a square: four straight sides, with turns on the spot between them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.sign_for_sum import sign_for_sum
from grader.checks.causes.too_soon import too_soon
from grader.checks.causes.why_rate import why_timers_grow
from grader.checks.causes.why_steering import why_steering
from grader.checks.kind import Kind, choice, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.requested import Requested, first_heading
from grader.checks.starved import unless_starved
from grader.checks.subjects.path import not_driven
from grader.checks.subjects.standstill import ZEROS, no_standstill, silent_while_moving
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import count
from grader.common.words import number as shown
from grader.evidence.trajectory import RESTS_M, STRAIGHT_RAD

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.evidence.trajectory import Trajectory

SIDES = 4
ORDINALS = ("first", "second", "third", "fourth")
STRAIGHT_RAD_M = 0.2
"""A part of the trajectory that turns by at most this angle per metre (a radius of at least 5 m) is straight."""
CURVED_SHARE = 0.1
"""If more than this fraction of the trajectory is curved, the trajectory is not a square."""
SHORT_M = 0.05
"""A straight part that is shorter than this (m) is not a side."""


@dataclass(frozen=True, kw_only=True)
class Square:
    """Requires sides of this length and corners of 90 degrees, and that the turtle stops where it started."""

    side_m: float = number(above=0, at_most=5, about="The length of a side.")
    side_tolerance_m: float = number(0.15, above=0, about="The maximum error in the length of a side.")
    corner_tolerance_deg: float = number(
        7.0, above=0, about="The maximum difference between the angle of a corner and 90 degrees."
    )
    closing_m: float = number(0.4, above=0, about="The maximum distance from the start to the end of the fourth side.")
    direction: str = choice("counter-clockwise", "clockwise", "either", about="The direction of the turn.")


@dataclass(frozen=True)
class Sides:
    """The straight parts of a path: their lengths (m), headings (rad) and ends (m), and the turns between them (rad).

    After the last side of the figure, the turtle drives `more_m` (m) and turns by `more_rad` (rad).
    """

    lengths: tuple[float, ...]
    headings: tuple[float, ...]
    corners: tuple[float, ...]
    ends: tuple[tuple[float, float], ...]
    curved_share: float
    more_m: float
    more_rad: float


def sides_of(trajectory: Trajectory, amount: int = SIDES) -> Sides:
    """Split the trajectory at its corners. `amount` is the number of sides of the required figure."""
    moves = trajectory.steps > RESTS_M
    straight = moves & (np.abs(trajectory.turn) <= STRAIGHT_RAD_M * trajectory.steps)
    curved = moves & ~straight
    frames = np.flatnonzero(straight)
    turned = np.cumsum(trajectory.turn)
    # A side ends where the heading changes by more than noise before the next straight frame.
    breaks = np.flatnonzero(np.abs(np.diff(turned[frames])) > math.radians(10.0)) + 1
    pieces = [piece for piece in np.split(frames, breaks) if trajectory.steps[piece].sum() > SHORT_M]
    after = int(pieces[amount - 1][-1]) + 1 if len(pieces) >= amount else len(trajectory.steps)
    return Sides(
        lengths=tuple(float(trajectory.steps[piece].sum()) for piece in pieces),
        headings=tuple(_heading(trajectory, int(piece[0]), int(piece[-1]) + 1) for piece in pieces),
        corners=tuple(float(turned[after[0]] - turned[before[-1]]) for before, after in pairwise(pieces)),
        ends=tuple((float(trajectory.x[piece[-1] + 1]), float(trajectory.y[piece[-1] + 1])) for piece in pieces),
        curved_share=float(trajectory.steps[curved].sum()) / trajectory.length_m if trajectory.length_m else 0.0,
        more_m=float(trajectory.steps[after:].sum()),
        more_rad=float(trajectory.turn[after:].sum()),
    )


def _heading(trajectory: Trajectory, begin: int, end: int) -> float:
    x, y = trajectory.x, trajectory.y
    return math.atan2(float(y[end] - y[begin]), float(x[end] - x[begin]))


def square(evidence: Evidence, params: Square) -> Finding:
    """The turtle drives four equal sides with corners of 90 degrees, and stands still where it started."""
    expected = (
        f"The turtle drives four straight sides of {shown(params.side_m)} m, and turns by 90 degrees on the spot after "
        "each side."
    )
    where = evidence.place("publish")
    trajectory = evidence.trajectory
    still = not_driven(evidence, expected, where)
    if still is not None:
        return still
    if trajectory.wall.any():
        text = "A side is too long, a corner has the wrong angle, or the turtle does not stop after the fourth side."
        if len(sides_of(trajectory).lengths) == 1 and not float(np.abs(trajectory.turn).sum()):
            text = "The turtle never turned. After the last timer call of a side, the state must change."
        into = sign_for_sum(evidence, "wall") or Cause("wall", text, where)
        return failed("The turtle ran into a wall.", expected, into)
    sides = sides_of(trajectory)
    if sides.curved_share > CURVED_SHARE:
        observed = f"{100.0 * sides.curved_share:.0f} % of the trajectory is curved."
        cause = "Drive with angular.z at 0, then turn with linear.x at 0. Never drive and turn at the same time."
        return failed(observed, expected, Cause("curves", cause, where))
    if len(sides.lengths) < SIDES:
        observed = f"The trajectory has {count(len(sides.lengths), 'side')}."
        cause = (
            "Four sides and the turns between them must fit into the duration of the trial. "
            "After each turn, the node must switch back to driving."
        )
        known = why_steering(evidence) or why_timers_grow(evidence)
        return failed(observed, expected, known or Cause("too-few-sides", cause, where))
    return _measured(evidence, params, sides, expected)


def _measured(evidence: Evidence, params: Square, sides: Sides, expected: str) -> Finding:
    where, recording = evidence.place("publish"), evidence.recording
    speed = recording.frames.linear
    long, right = Band.around(params.side_m, params.side_tolerance_m), Band.around(90.0, params.corner_tolerance_deg)
    corners = [math.degrees(corner) for corner in sides.corners[: SIDES - 1]]
    sign = -1.0 if params.direction == "clockwise" or (params.direction == "either" and corners[0] < 0.0) else 1.0
    near = long.near(*sides.lengths[:SIDES]) or right.near(*(sign * corner for corner in corners))
    if all(sign * corner < 0.0 for corner in corners):
        observed = "The turtle turns in the wrong direction at the corners."
        return failed(
            observed, f"The turtle drives the square {params.direction}.", Cause("wrong-direction", where=where)
        )
    for name, length in zip(ORDINALS, sides.lengths, strict=False):
        if not long.holds(length):
            more = length - params.side_m
            observed = (
                f"The {name} side is {length:.2f} m long: {abs(more):.2f} m too {'long' if more > 0 else 'short'}."
            )
            cause = (
                "The length of a side is speed times time. The time is the number of timer calls times the timer "
                "period."
            )
            finding = failed(observed, expected, Cause("side-length", cause, where), near_edge=near)
            if name == ORDINALS[0] and more < 0.0 and all(map(long.holds, sides.lengths[1:SIDES])):
                finding = too_soon(finding, evidence)
            return unless_starved(finding, recording, abs(more) - params.side_tolerance_m, float(speed.max()))
    for name, corner in zip(ORDINALS, corners, strict=False):
        if not right.holds(sign * corner):
            observed = f"At the {name} corner, the turtle turns by {sign * corner:.0f} degrees."
            cause = "A quarter turn is pi / 2 rad, which is turning speed times time."
            finding = failed(observed, expected, Cause("corner-angle", cause, where), near_edge=near)
            off = abs(sign * corner - 90.0) - params.corner_tolerance_deg
            return unless_starved(finding, recording, off, math.degrees(float(np.abs(recording.frames.angular).max())))
    gap = math.dist(sides.ends[SIDES - 1], (evidence.recording.start.x, evidence.recording.start.y))
    closed = Band.at_most(params.closing_m)
    if not closed.holds(gap):
        observed = f"The fourth side ends {gap:.2f} m away from the start position."
        finding = failed(observed, expected, Cause("square-gap", where=where), near_edge=True)
        return unless_starved(finding, recording, gap - params.closing_m, SIDES * float(speed.max()))
    further = _drives_on(evidence, params, sides, sign, expected)
    if further is not None:
        return further
    observed = f"The turtle drove a square with sides of {shown(params.side_m)} m."
    return passed(observed, near_edge=near or closed.near(gap))


def _drives_on(evidence: Evidence, params: Square, sides: Sides, sign: float, expected: str) -> Finding | None:
    """Return None if the turtle stops after the fourth side or after one more corner, else a failed finding."""
    where = evidence.place("publish")
    turned = math.degrees(sign * sides.more_rad)
    last = (Band.around(0.0, params.corner_tolerance_deg), Band.around(90.0, params.corner_tolerance_deg))
    cause = f"After four sides, the node needs a state in which the turtle stands still. {ZEROS}"
    if sides.more_m > SHORT_M:
        observed = f"After the fourth side, the turtle drives {sides.more_m:.1f} m further."
    elif not any(band.holds(turned) for band in last):
        observed = f"After the fourth side, the turtle turns by {turned:.0f} degrees."
    else:
        return no_standstill(evidence, expected)
    unfinished = sides.more_m <= SHORT_M and 0.0 < turned < 90.0 and bool(evidence.trajectory.turn[-1])
    if unfinished:
        cause = "At the end of the trial, the turtle was still turning: the square took too long."
    elif silent_while_moving(evidence):
        cause = f"The last command has values other than 0, so the turtle continues for one second. {ZEROS}"
    return failed(observed, "After four sides, the turtle stands still.", Cause("drives-on", cause, where))


def requested_square(evidence: Evidence, params: Square) -> Requested:
    """Return the corners of the square, with the first corner again at the end.

    If both directions are allowed, the corners follow the direction in which the turtle drove.
    """
    begin = first_heading(evidence)
    turn = evidence.trajectory.turn[np.abs(evidence.trajectory.turn) > STRAIGHT_RAD]
    taken = -1.0 if len(turn) and turn[-1] < 0.0 else 1.0
    side = {"clockwise": -1.0, "counter-clockwise": 1.0}.get(params.direction, taken)
    x, y, corners = begin.x, begin.y, [(begin.x, begin.y)]
    for number_ in range(SIDES):
        theta = begin.theta + side * number_ * math.pi / 2.0
        x, y = x + params.side_m * math.cos(theta), y + params.side_m * math.sin(theta)
        corners.append((x, y))
    return Requested(f"sides of {params.side_m:.2f} m", lines=(tuple(corners),))


SQUARE = Kind(
    "square",
    "trial",
    "The turtle drives a square",
    Square,
    square,
    about="The turtle drives four straight sides with corners of 90 degrees, returns to its start, and stands still.",
    drives=True,
    requested=requested_square,
)

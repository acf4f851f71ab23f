"""Check of a star: straight sides, and turns on the spot by action goals between the sides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, failed, passed
from grader.checks.requested import Requested
from grader.checks.subjects.path import MOVED_M
from grader.checks.subjects.square import CURVED_SHARE, SHORT_M, Sides, sides_of
from grader.checks.subjects.standstill import no_standstill
from grader.checks.tolerance import Band
from grader.common.words import count
from grader.evidence.interventions import ALWAYS, MOVING

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

BY_GOALS = "rotate_absolute"
TOGETHER_S = 0.03
"""Two commands that arrive within this time (s) were sent during a single call to a method."""


@dataclass(frozen=True, kw_only=True)
class Star:
    """Requires a closed star with sides of this length. Between two sides, the turtle turns left by `corner_deg`."""

    side_m: float = number(above=0, at_most=5, about="The length of a side.")
    heading_deg: float = number(about="The heading of the first side, in degrees: 0 is to the right, 90 is up.")
    sides: float = number(5, at_least=3, about="The number of sides.")
    corner_deg: float = number(144.0, about="The turn to the left from one side to the next.")
    side_tolerance_m: float = number(0.15, above=0, about="The maximum error in the length of a side.")
    corner_tolerance_deg: float = number(6.0, above=0, about="The maximum error in the heading of a side.")
    closing_m: float = number(0.4, above=0, about="The maximum distance from the start to the end of the last side.")


def star(evidence: Evidence, params: Star) -> Finding:
    """The turtle draws a star: velocity commands drive the turtle along the sides, and action goals turn it."""
    amount = int(params.sides)
    expected = (
        f"The turtle drives {amount} straight sides of {params.side_m:g} m: the first with a heading of "
        f"{params.heading_deg:g} degrees, and each following side {abs(params.corner_deg):g} degrees further to the "
        f"{'left' if params.corner_deg > 0 else 'right'}."
    )
    where, trajectory = evidence.place("publish"), evidence.trajectory
    others = [name for name in evidence.recording.interventions if name in (MOVING | ALWAYS) - {BY_GOALS}]
    if others:
        observed = f"Something other than commands and goals may have moved the turtle: {others[0]}."
        return failed(observed, expected, Cause("intervention", "", evidence.place("create_client")))
    if not (trajectory.finite and trajectory.length_m > MOVED_M):
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        cause = why_blocked(evidence) or Cause("not-moving", where=where)
        return failed("The turtle did not drive.", expected, cause)
    if trajectory.wall.any():
        text = "A side is too long, a heading is wrong, or the turtle does not stop after the last side."
        return failed("The turtle ran into a wall.", expected, Cause("wall", text, where))
    sides = sides_of(trajectory, amount)
    if sides.curved_share > CURVED_SHARE:
        observed = f"{100.0 * sides.curved_share:.0f} % of the trajectory is curved."
        return failed(observed, expected, Cause("curves", "The goals turn the turtle: angular.z stays 0.", where))
    if len(sides.lengths) < amount:
        observed = f"The trajectory has {count(len(sides.lengths), 'side')}."
        text = f"All sides and corners must fit into the {evidence.recording.duration_s:g} s of the trial."
        return failed(observed, expected, Cause("too-few-sides", text, where))
    return _measured(evidence, params, sides, expected)


def _measured(evidence: Evidence, params: Star, sides: Sides, expected: str) -> Finding:
    where, amount = evidence.place("publish"), int(params.sides)
    long, right = Band.around(params.side_m, params.side_tolerance_m), Band.around(0.0, params.corner_tolerance_deg)
    lengths = sides.lengths[:amount]
    near = long.near(*lengths)
    for index, length in enumerate(lengths):
        if long.holds(length):
            continue
        observed = f"Side {index + 1} is {length:.2f} m long."
        text = "The length of a side is speed times time. The time is the number of timer calls times the timer period."
        if length > params.side_m and all(command.linear[0] for command in evidence.commands):
            text = (
                "The node sends no command with zeros at the end of a side, so the turtle continues. Publish a command "
                "with zeros after each side."
            )
        if length < params.side_m and _is_cut(evidence):
            text = (
                "The command with zeros arrives together with the last command of the side, and replaces it. Send the "
                "zeros when the timer fires the next time."
            )
        return failed(observed, expected, Cause("side-length", text, where), near_edge=near)
    for index, heading in enumerate(sides.headings[:amount]):
        off = math.degrees(heading) - params.heading_deg - index * params.corner_deg
        off = (off + 180.0) % 360.0 - 180.0
        near = near or right.near(off)
        if not right.holds(off):
            observed = f"Side {index + 1} has a heading of {math.degrees(heading) % 360.0:.0f} degrees."
            text = "The heading of a goal is absolute: 0 is to the right, whatever the heading was before."
            return failed(observed, expected, Cause("corner-angle", text, where), near_edge=near)
    gap = math.dist(sides.ends[amount - 1], (float(evidence.trajectory.x[0]), float(evidence.trajectory.y[0])))
    closed = Band.at_most(params.closing_m)
    if not closed.holds(gap):
        observed = f"The last side ends {gap:.2f} m away from the start position."
        return failed(observed, expected, Cause("square-gap", where=where), near_edge=True)
    if sides.more_m > SHORT_M:
        observed = f"After the last side, the turtle drives {sides.more_m:.1f} m further."
        text = "After the last side, the node needs a state in which it does nothing."
        return failed(observed, expected, Cause("drives-on", text, where))
    rest = no_standstill(evidence, expected)
    return rest or passed(f"The turtle drew a star of {amount} sides.", near_edge=near or closed.near(gap))


def _is_cut(evidence: Evidence) -> bool:
    """Return whether each command that ends a side arrives together with the last command that drives along it."""
    pairs = list(pairwise(evidence.commands))
    ends = [later for before, later in pairs if before.linear[0] and not later.linear[0]]
    cut = [later for before, later in pairs if later in ends and later.t_s - before.t_s < TOGETHER_S]
    return bool(ends) and len(cut) == len(ends)


def requested_star(evidence: Evidence, params: Star) -> Requested:
    """Return the corners of the star, with the first corner again at the end."""
    x, y = evidence.recording.start.x, evidence.recording.start.y
    corners = [(x, y)]
    for index in range(int(params.sides)):
        theta = math.radians(params.heading_deg + index * params.corner_deg)
        x, y = x + params.side_m * math.cos(theta), y + params.side_m * math.sin(theta)
        corners.append((x, y))
    return Requested(f"sides of {params.side_m:.2f} m", lines=(tuple(corners),))


STAR = Kind(
    "star",
    "trial",
    "The turtle draws a star",
    Star,
    star,
    about=(
        "The turtle drives straight sides, and action goals turn it between the sides. The turtle stops at its "
        "start position."
    ),
    drives=True,
    requested=requested_star,
    # No point of the star is further from its start than the length of a side, and the walls have a margin anyway.
    radius_m=lambda params: max(params.side_m - 0.4, 0.1),
)
